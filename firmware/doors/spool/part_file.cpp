#include "spool/part_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "icd/sentence.hpp"
#include "loop/regular_file.hpp"

namespace adit::spool {
namespace {

constexpr std::size_t kSmall = 4096;  // bytes: larger files are mapped

std::expected<MappedFile, int> map_file(int fd) {
  struct stat status{};
  if (::fstat(fd, &status) != 0) return std::unexpected(errno);
  if (status.st_size == 0) return MappedFile{};
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const begin = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd, 0);
  if (begin == MAP_FAILED) return std::unexpected(errno);
  const auto unmap = [size](void* mapped) { ::munmap(mapped, size); };
  return MappedFile{std::shared_ptr<void>(begin, unmap), {static_cast<const std::uint8_t*>(begin), size}};
}

std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

std::expected<MappedFile, int> map_file(const std::string& path) {
  const loop::FileDescriptor fd = loop::open_regular(path, O_RDONLY);
  if (!fd) return std::unexpected(errno);
  auto small = loop::read_all(fd, kSmall);
  if (!small && small.error() != EFBIG) return std::unexpected(small.error());
  if (!small) return map_file(fd.get());
  const auto owner = std::make_shared<std::string>(std::move(*small));
  return MappedFile{owner, as_bytes(*owner)};
}

std::string_view text_in(const MappedFile& file) {
  return {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
}

icd::Refusal unreadable(const std::string& path, int error) {
  const auto status = error == ENOENT ? icd::Status::UnprocessableEntity : icd::Status::ServiceUnavailable;
  return {status, icd::sentence("cannot read ", path, ": ", loop::text_of(error))};
}

PartFile::PartFile(const std::string& path)
    : part_(path + ".XXXXXX" + std::string(kEnding)),
      fd_(::mkostemps(part_.data(), static_cast<int>(kEnding.size()), O_CLOEXEC)) {
  if (!fd_) error_ = errno;
}

PartFile::~PartFile() {
  if (fd_ && !named_) ::unlink(part_.c_str());
}

int PartFile::append(icd::ChunkedBytes& bytes) {
  while (!bytes.empty()) {
    const auto chunk = *bytes.chunks().front();
    if (const int error = append({reinterpret_cast<const char*>(chunk.data()), chunk.size()}); error != 0)
      return error;
    bytes.pop_front();
  }
  return error_;
}

int PartFile::append(std::string_view bytes) {
  const int error = write(bytes, size_);
  if (error == 0) size_ += bytes.size();
  return error;
}

int PartFile::write(std::string_view bytes, std::size_t place) const {
  return error_ != 0 ? error_ : loop::write_all(fd_.get(), bytes, place);
}

std::expected<MappedFile, int> PartFile::map() const {
  return map_file(fd_.get());
}

int PartFile::name(const std::string& path) {
  if (error_ != 0) return error_;
  if (std::rename(part_.c_str(), path.c_str()) != 0) return errno;
  named_ = true;
  return 0;
}

}  // namespace adit::spool
