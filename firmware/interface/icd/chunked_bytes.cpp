#include "icd/chunked_bytes.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "icd/require.hpp"

namespace adit::icd {

void ChunkedBytes::swap(ChunkedBytes& other) noexcept {
  std::swap(chunks_, other.chunks_);
  std::swap(first_, other.first_);
  std::swap(open_, other.open_);
  std::swap(size_, other.size_);
}

/// Keeps the last chunk if it has room and is not shared. Otherwise begins a new one.
void ChunkedBytes::open_chunk() {
  constexpr long kOurs = 2;  // open_ and chunks_.back()
  if (open_ && open_->size() < kChunk && open_.use_count() == kOurs) {
    std::atomic_thread_fence(std::memory_order_acquire);  // after a former sharer's last access
#ifdef __SANITIZE_THREAD__
    (void)std::shared_ptr(open_);  // GCC's thread sanitizer knows no fences, but this count's increment
#endif
    return;
  }
  open_ = std::make_shared<std::vector<std::uint8_t>>();
  chunks_.emplace_back(open_, *open_);
}

/// Adds to the open chunk. Requires room for `piece`.
void ChunkedBytes::grow(std::span<const std::uint8_t> piece) {
  std::vector<std::uint8_t>& chunk = *open_;
  if (chunk.capacity() - chunk.size() < piece.size()) {
    chunk.reserve(std::min(kChunk, std::max(chunk.size() + piece.size(), 2 * chunk.capacity())));
  }
  chunk.insert(chunk.end(), piece.begin(), piece.end());
  chunks_.back().bytes_ = chunk;
  size_ += piece.size();
}

void ChunkedBytes::append(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    open_chunk();
    const auto piece = bytes.first(std::min(bytes.size(), kChunk - open_->size()));
    grow(piece);
    bytes = bytes.subspan(piece.size());
  }
}

void ChunkedBytes::append(const ChunkedBytes& other) {
  const std::vector<Chunk> theirs(other.chunks().begin(), other.chunks().end());  // other may be *this
  const std::size_t size = other.size_;
  chunks_.insert(chunks_.end(), theirs.begin(), theirs.end());
  size_ += size;
  if (!theirs.empty()) open_.reset();
}

void ChunkedBytes::append(std::vector<std::uint8_t>&& chunk) {
  if (chunk.empty()) return;
  if (chunk.size() > kChunk) return append(std::span<const std::uint8_t>(chunk));
  open_.reset();
  size_ += chunk.size();
  const auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(chunk));
  chunks_.emplace_back(owner, *owner);
}

void ChunkedBytes::append(const std::shared_ptr<const void>& owner, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) open_.reset();
  size_ += bytes.size();
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), kChunk))) {
    chunks_.emplace_back(owner, bytes.first(std::min(bytes.size(), kChunk)));
  }
}

ChunkedBytes::Chunk ChunkedBytes::pop_front() {
  require(!empty());
  Chunk chunk = std::move(chunks_[first_++]);
  size_ -= chunk->size();
  if (first_ == chunks_.size()) {
    chunks_.clear();
    open_.reset();
    first_ = 0;
  }
  return chunk;
}

std::vector<std::uint8_t> ChunkedBytes::to_vector() const {
  std::vector<std::uint8_t> all;
  all.reserve(size_);
  for (const Chunk& chunk : chunks()) all.insert(all.end(), chunk->begin(), chunk->end());
  return all;
}

std::string ChunkedBytes::to_string() const {
  std::string all;
  all.reserve(size_);
  for (const Chunk& chunk : chunks()) all.append(chunk->begin(), chunk->end());
  return all;
}

bool operator==(const ChunkedBytes& a, const ChunkedBytes& b) {
  if (a.size_ != b.size_) return false;
  std::size_t chunk = 0;
  std::size_t at = 0;  // in b's chunk
  for (const auto& ours : a.chunks()) {
    std::span<const std::uint8_t> left(*ours);
    while (!left.empty()) {
      const auto theirs = std::span<const std::uint8_t>(*b.chunks()[chunk]).subspan(at);
      const std::size_t length = std::min(left.size(), theirs.size());
      if (!std::ranges::equal(left.first(length), theirs.first(length))) return false;
      left = left.subspan(length);
      at += length;
      if (length == theirs.size()) {
        ++chunk;
        at = 0;
      }
    }
  }
  return true;
}

}  // namespace adit::icd
