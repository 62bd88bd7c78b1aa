#include "rehearsal/command_post/sockets.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <system_error>

namespace adit::rehearsal {
namespace {

using Infos = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Infos numeric_address(const Address& address) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address.port);
  if (::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found) != 0) found = nullptr;
  return {found, ::freeaddrinfo};
}

}  // namespace

int poll_again(std::span<pollfd> waited, int patience_ms) {
  int ready = -1;
  do {
    ready = ::poll(waited.data(), waited.size(), patience_ms);
  } while (ready < 0 && errno == EINTR);
  return ready;
}

std::expected<loop::FileDescriptor, std::string> listening_socket(const Address& address) {
  const auto failed = [&] {
    return std::unexpected(address.text() + ": " + std::error_code(errno, std::generic_category()).message());
  };
  const Infos info = numeric_address(address);
  if (!info) return std::unexpected(address.text() + ": not a numeric address");
  loop::FileDescriptor socket(::socket(info->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return failed();
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(socket.get(), info->ai_addr, info->ai_addrlen) != 0) return failed();
  if (::listen(socket.get(), SOMAXCONN) != 0) return failed();
  return socket;
}

std::optional<Address> local_address_of(int socket) {
  sockaddr_storage storage{};
  socklen_t length = sizeof storage;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&storage), &length) != 0) return std::nullopt;
  char host[NI_MAXHOST];
  char port[NI_MAXSERV];
  if (::getnameinfo(reinterpret_cast<sockaddr*>(&storage), length, host, sizeof host, port, sizeof port,
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return std::nullopt;
  }
  Address address{host, 0};
  std::from_chars(port, port + std::strlen(port), address.port);
  return address;
}

}  // namespace adit::rehearsal
