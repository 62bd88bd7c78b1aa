#include "host/untrusted_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "host/files.hpp"
#include "host/service.hpp"
#include "loop/regular_file.hpp"

namespace adit::host {
namespace {

/// Opens without following links.
loop::FileDescriptor open_file(const loop::FileDescriptor& folder, const std::string& name, int how) {
  return loop::open_regular(name, how | O_NOFOLLOW, folder.get());
}

}  // namespace

std::expected<UntrustedFolder, std::string> UntrustedFolder::open(const std::string& path) {
  loop::FileDescriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!folder) return std::unexpected(path_error(path, errno));
  return UntrustedFolder(std::move(folder));
}

std::expected<std::optional<std::string>, UntrustedFolder::ReadFailure> UntrustedFolder::take_file(
    const std::string& name) {
  auto text = read(name);
  if (text && !*text) return std::nullopt;
  if (auto gone = remove(name); !gone)
    return std::unexpected(ReadFailure{.why = std::move(gone.error()), .stays = true});
  if (!text) return std::unexpected(ReadFailure{.why = std::move(text.error())});
  return *std::move(text);
}

std::expected<void, std::string> UntrustedFolder::remove(const std::string& name) {
  if (unlinkat(folder_.get(), name.c_str(), 0) == 0 || errno == ENOENT) return {};
  const auto stays = [&name] { return std::unexpected("cannot remove it: " + path_error(name, errno)); };
  if (errno != EISDIR) return stays();
  const std::string path = path_by_descriptor() + '/' + name;
  std::string aside = path + ".XXXXXX";
  if (mkdtemp(aside.data()) == nullptr) return stays();
  if (::rename(path.c_str(), aside.c_str()) != 0) {
    const int error = errno;
    rmdir(aside.c_str());
    errno = error;
    return stays();
  }
  std::error_code left;
  std::filesystem::remove_all(aside, left);
  return {};
}

std::expected<std::optional<std::string>, std::string> UntrustedFolder::read(const std::string& name) const {
  const loop::FileDescriptor fd = open_file(folder_, name, O_RDONLY);
  if (!fd && errno == ENOENT) return std::nullopt;
  if (!fd) return std::unexpected(path_error(name, errno));
  auto text = loop::read_all(fd, kLargest);
  if (!text) return std::unexpected(path_error(name, text.error()));
  return std::move(*text);
}

std::expected<std::optional<UntrustedFolder>, std::string> UntrustedFolder::folder(
    const std::string& name) const {
  loop::FileDescriptor fd(
      openat(folder_.get(), name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!fd && errno == ENOENT) return std::nullopt;
  if (!fd) return std::unexpected(path_error(name, errno));
  return UntrustedFolder(std::move(fd));
}

std::expected<std::vector<std::string>, std::string> UntrustedFolder::names() const {
  return names_in(path_by_descriptor());
}

bool UntrustedFolder::wipe(const std::string& name) {
  const loop::FileDescriptor fd = open_file(folder_, name, O_WRONLY);
  struct stat status{};
  bool blank = fd && fstat(fd.get(), &status) == 0;
  const std::string zeros(4096, '\0');
  for (std::size_t at = 0, end = static_cast<std::size_t>(status.st_size); blank && at < end;
       at += zeros.size())
    blank = loop::write_all(fd.get(), std::string_view(zeros).substr(0, end - at), at) == 0;
  blank = blank && fsync(fd.get()) == 0;
  return unlinkat(folder_.get(), name.c_str(), 0) == 0 && fsync(folder_.get()) == 0 && blank;
}

}  // namespace adit::host
