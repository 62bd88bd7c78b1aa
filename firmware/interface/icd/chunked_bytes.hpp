#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace adit::icd {

/// Some bytes and their owner: a vector, or a file that is mapped into memory.
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

/// Bytes in chunks of at most kChunk, shared (also by copies) and never changed once written. So a map can be
/// queued, merged, sent and retried without a second copy. Threads may share chunks, but not a ChunkedBytes.
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
  /// Moves `chunk` to the end; copies it if it is larger than kChunk.
  void append(std::vector<std::uint8_t>&& chunk);
  /// Appends `bytes` of any size without a copy. They must stay valid and unchanged while `owner` lives.
  void append(const std::shared_ptr<const void>& owner, std::span<const std::uint8_t> bytes);

  /// All bytes, in order. No chunk is empty.
  std::span<const Chunk> chunks() const { return std::span(chunks_).subspan(first_); }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Removes the first chunk, so that it can be freed after use. Requires !empty().
  Chunk pop_front();

  /// One contiguous copy, for small bodies and tests.
  std::vector<std::uint8_t> to_vector() const;
  std::string to_string() const;

  /// Compares the bytes; the borders of chunks do not matter.
  friend bool operator==(const ChunkedBytes& a, const ChunkedBytes& b);

 private:
  void swap(ChunkedBytes& other) noexcept;
  void grow(std::span<const std::uint8_t> piece);
  void open_chunk();

  std::vector<Chunk> chunks_;
  std::size_t first_ = 0;                            // index of the first chunk that was not popped
  std::shared_ptr<std::vector<std::uint8_t>> open_;  // the last chunk, while it may still grow
  std::size_t size_ = 0;
};

}  // namespace adit::icd
