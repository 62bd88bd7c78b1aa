#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace adit::icd {

/// Some bytes and whatever keeps them alive: a vector of their own, or a file that is mapped into memory.
class Chunk {
 public:
  Chunk() = default;
  Chunk(std::shared_ptr<const void> owner, std::span<const std::uint8_t> bytes)
      : owner_(std::move(owner)), bytes_(bytes) {}
  std::span<const std::uint8_t> operator*() const { return bytes_; }
  const std::span<const std::uint8_t>* operator->() const { return &bytes_; }
  const std::shared_ptr<const void>& owner() const { return owner_; }

 private:
  friend class ChunkedBytes;
  std::shared_ptr<const void> owner_;
  std::span<const std::uint8_t> bytes_;
};

/// Bulk bytes in chunks of at most kChunk that are shared and never changed once written, so that a map is
/// queued, merged with another, sent and sent again without a second copy, wherever its bytes are.
///
/// Copying a ChunkedBytes shares its chunks. Not for use by two threads at once, though chunks may be shared
/// across threads.
class ChunkedBytes {
 public:
  static constexpr std::size_t kChunk = std::size_t{64} * 1024;
  using Chunk = icd::Chunk;

  ChunkedBytes() = default;
  ChunkedBytes(const ChunkedBytes&) = default;
  /// Leaves `other` empty.
  ChunkedBytes(ChunkedBytes&& other) noexcept { swap(other); }
  ChunkedBytes& operator=(ChunkedBytes other) noexcept {
    swap(other);
    return *this;
  }
  ~ChunkedBytes() = default;
  explicit ChunkedBytes(std::span<const std::uint8_t> bytes) { append(bytes); }

  /// Copies `bytes` to the end.
  void append(std::span<const std::uint8_t> bytes);
  /// Shares the chunks of `other` at the end.
  void append(const ChunkedBytes& other);
  /// Takes a whole chunk over, without a copy where it is no larger than kChunk.
  void append(std::vector<std::uint8_t>&& chunk);
  /// Shows `bytes`, of any size, which live and do not change while `owner` lives, without a copy.
  void append(const std::shared_ptr<const void>& owner, std::span<const std::uint8_t> bytes);

  /// All bytes, in order; no chunk is empty.
  std::span<const Chunk> chunks() const { return std::span(chunks_).subspan(first_); }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Takes the first chunk out, so that what has been worked on can be freed. Requires !empty().
  Chunk pop_front();

  /// One contiguous copy: for small bodies and for tests.
  std::vector<std::uint8_t> to_vector() const;
  std::string to_string() const;

  /// Equal bytes, however they are cut into chunks.
  friend bool operator==(const ChunkedBytes& a, const ChunkedBytes& b);

 private:
  void swap(ChunkedBytes& other) noexcept;
  void grow(std::span<const std::uint8_t> piece);
  void open_chunk();

  std::vector<Chunk> chunks_;
  std::size_t first_ = 0;                            // of chunks_ that has not been popped
  std::shared_ptr<std::vector<std::uint8_t>> open_;  // the last chunk, while it may still grow
  std::size_t size_ = 0;
};

}  // namespace adit::icd
