#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::spool {

/// A file's bytes in memory: those of a large file on a tmpfs are the file itself. They live as long as their
/// owner.
struct MappedFile {
  std::shared_ptr<const void> owner;
  std::span<const std::uint8_t> bytes;
};
/// The bytes of a file, or the errno of why it cannot be read. Those of a small file are a copy: to map it
/// takes longer.
std::expected<MappedFile, int> map_file(const std::string& path);
std::string_view text_in(const MappedFile& file);
/// 503 and why; but if there is no such file, 422: what it had is lost.
icd::Refusal unreadable(const std::string& path, int error);

/// A file of this user alone that is not whole yet: it has another name until name(), and is gone with this
/// object if it never comes to that. For one thread at a time. What fails gives the errno, else 0.
class PartFile {
 public:
  /// Files that end so, and that nobody writes, were left by a kill.
  static constexpr std::string_view kEnding = ".part";

  /// `path`: what it is named after meanwhile, but as no other is.
  explicit PartFile(const std::string& path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  std::size_t size() const { return size_; }
  /// Writes at the end, and frees each chunk as it is written. Where it fails, `bytes` is what is left to
  /// write.
  int append(icd::ChunkedBytes& bytes);
  int append(std::string_view bytes);
  /// Overwrites what stands at the beginning.
  int begin_with(std::string_view bytes) const { return write(bytes, 0); }
  std::expected<MappedFile, int> map() const;
  /// From now on it is that file, in the place of the one before.
  int name(const std::string& path);

 private:
  int write(std::string_view bytes, std::size_t place) const;

  std::string part_;
  loop::FileDescriptor fd_;
  int error_ = 0;  // of its making
  std::size_t size_ = 0;
  bool named_ = false;
};

}  // namespace adit::spool
