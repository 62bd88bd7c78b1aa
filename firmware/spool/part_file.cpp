#include "spool/part_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace adit::spool {
namespace {

MappedFile map_file(int fd) {
  struct stat status{};
  if (::fstat(fd, &status) != 0 || status.st_size == 0) return {};
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const begin = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd, 0);
  if (begin == MAP_FAILED) return {};
  const auto unmap = [size](void* mapped) { ::munmap(mapped, size); };
  return {std::shared_ptr<void>(begin, unmap), {static_cast<const std::uint8_t*>(begin), size}};
}

std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

MappedFile map_file(const std::string& path) {
  const loop::FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  return fd ? map_file(fd.get()) : MappedFile{};
}

PartFile::PartFile(const std::string& path)
    : part_(path + ".XXXXXX" + std::string(kEnding)),
      fd_(::mkostemps(part_.data(), static_cast<int>(kEnding.size()), O_CLOEXEC)) {
  if (!fd_) error_ = errno;
}

PartFile::~PartFile() {
  if (fd_ && !named_) ::unlink(part_.c_str());
}

int PartFile::write(std::span<const std::uint8_t> bytes, std::size_t place) {
  while (error_ == 0 && !bytes.empty()) {
    const ssize_t count = ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    place += static_cast<std::size_t>(count);
  }
  return error_;
}

int PartFile::append(icd::ChunkedBytes& bytes) {
  while (!bytes.empty()) {
    const auto chunk = *bytes.chunks().front();
    if (const int error = write(chunk, size_); error != 0) return error;
    size_ += chunk.size();
    bytes.pop_front();
  }
  return error_;
}

int PartFile::append(std::string_view bytes) {
  const int error = write(as_bytes(bytes), size_);
  if (error == 0) size_ += bytes.size();
  return error;
}

int PartFile::begin_with(std::string_view bytes) {
  return write(as_bytes(bytes), 0);
}

MappedFile PartFile::map() const {
  return map_file(fd_.get());
}

int PartFile::name(const std::string& path) {
  if (error_ != 0) return error_;
  if (std::rename(part_.c_str(), path.c_str()) != 0) return errno;
  named_ = true;
  return 0;
}

}  // namespace adit::spool
