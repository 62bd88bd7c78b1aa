#include "panel/unix_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>

namespace adit::panel {
namespace {

constexpr int kWaiting = 4;  // connections not yet accepted
constexpr int kKind = SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC;

std::optional<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) return std::nullopt;
  std::ranges::copy(path, std::begin(address.sun_path));
  return address;
}

/// The address type of the C interface.
const sockaddr* plain(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);  // NOLINT(cppcoreguidelines-pro-type-reinterpret-cast)
}

}  // namespace

std::expected<loop::FileDescriptor, int> connected_to(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return std::unexpected(ENAMETOOLONG);
  loop::FileDescriptor fd(socket(AF_UNIX, kKind, 0));
  if (!fd || connect(fd.get(), plain(*address), sizeof(*address)) != 0) return std::unexpected(errno);
  return fd;
}

std::expected<loop::FileDescriptor, int> listening_at(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return std::unexpected(ENAMETOOLONG);
  if (unlink(path.c_str()) != 0 && errno != ENOENT) return std::unexpected(errno);
  loop::FileDescriptor fd(socket(AF_UNIX, kKind, 0));
  if (!fd || fchmod(fd.get(), S_IRUSR | S_IWUSR) != 0 ||
      bind(fd.get(), plain(*address), sizeof(*address)) != 0 || listen(fd.get(), kWaiting) != 0) {
    return std::unexpected(errno);
  }
  return fd;
}

std::expected<loop::FileDescriptor, int> accepted_at(const loop::FileDescriptor& listening) {
  loop::FileDescriptor fd(accept4(listening.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!fd) return std::unexpected(errno);
  return fd;
}

}  // namespace adit::panel
