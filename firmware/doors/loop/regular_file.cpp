#include "loop/regular_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace adit::loop {

std::string text_of(int error) {
  return error == kNotRegular ? "is not a regular file" : std::system_category().message(error);
}

FileDescriptor open_regular(const std::string& path, int flags, int folder) {
  FileDescriptor file(::openat(folder, path.c_str(), flags | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0600));
  struct stat found{};
  if (!file && errno != ENXIO && errno != EISDIR) return file;  // ENXIO: a FIFO without a reader, or a socket
  if (file && ::fstat(file.get(), &found) != 0) return {};
  if (file && S_ISREG(found.st_mode)) return file;
  file = {};
  errno = kNotRegular;
  return {};
}

std::expected<std::string, int> read_first(const FileDescriptor& file, std::size_t most) {
  struct stat found{};
  if (::fstat(file.get(), &found) != 0) return std::unexpected(errno);
  // In one piece, so that a large file is copied once. Files of /proc have no size.
  const std::size_t whole = std::min<std::size_t>(std::max<off_t>(found.st_size, 255) + 1, most);
  std::string bytes;
  while (bytes.size() < most) {
    const std::size_t had = bytes.size();
    ssize_t count = 0;
    bytes.resize_and_overwrite(had < whole ? whole : std::min(2 * had, most),
                               [&](char* data, std::size_t size) {
                                 count = ::read(file.get(), data + had, size - had);
                                 return had + static_cast<std::size_t>(std::max<ssize_t>(count, 0));
                               });
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::unexpected(errno);
    if (count == 0) break;
  }
  return bytes;
}

std::expected<std::string, int> read_all(const FileDescriptor& file, std::size_t most) {
  auto bytes = read_first(file, most + 1);
  if (bytes && bytes->size() > most) return std::unexpected(EFBIG);
  return bytes;
}

int write_all(int file, std::string_view bytes, std::size_t offset) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) return errno = EIO;
    bytes.remove_prefix(static_cast<std::size_t>(count));
    offset += static_cast<std::size_t>(count);
  }
  return 0;
}

}  // namespace adit::loop
