#include "loop/regular_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

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

std::expected<std::string, int> read_all(const FileDescriptor& file, std::size_t most) {
  std::string bytes;
  char buffer[16384];
  while (true) {
    const ssize_t count = ::read(file.get(), buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::unexpected(errno);
    if (count == 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(count));
    if (bytes.size() > most) return std::unexpected(EFBIG);
  }
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
