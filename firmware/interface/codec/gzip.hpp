#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "icd/mapping.hpp"
#include "icd/status.hpp"

namespace adit::codec {

enum class GzipStrategy : std::uint8_t {
  Default,  // zlib level 6, for text
  Runs,     // zlib level 6 with Z_RLE, for grids: two to five times faster and mostly smaller
};

/// Makes one gzip member (RFC 1952) without time or name in its header.
class Gzipper {
 public:
  explicit Gzipper(GzipStrategy strategy);
  ~Gzipper();
  Gzipper(Gzipper&&) noexcept;
  Gzipper& operator=(Gzipper&&) noexcept;

  void feed(std::span<const std::uint8_t> bytes);
  /// Bytes that take_some() would return.
  std::size_t available() const { return member_.size(); }
  /// The member's bytes since the last take_some(), in whole chunks.
  icd::ChunkedBytes take_some() { return std::move(member_); }
  /// The member, or its rest after take_some(). Call once, after the last feed().
  icd::ChunkedBytes finish();

 private:
  struct Stream;
  void deflate_with(int flush);
  void give_piece();

  std::unique_ptr<Stream> stream_;
  std::vector<std::uint8_t> piece_;  // output, until it is a whole chunk
  std::size_t made_ = 0;             // bytes in piece_
  icd::ChunkedBytes member_;
};

/// One gzip member. Consumes `bytes` chunk by chunk.
icd::ChunkedBytes gzip(icd::ChunkedBytes bytes, GzipStrategy strategy);

/// The last member's ISIZE (RFC 1952 2.3.1, modulo 2^32), right if gunzip() accepts it. 0: `bytes` too short.
std::size_t claimed_size(const icd::ChunkedBytes& bytes);

/// Receives inflated pieces and may refuse them.
using Sink = std::function<icd::Checked<void>(std::span<const std::uint8_t>)>;

/// Inflated bytes, and number of members.
struct Gunzipped {
  std::size_t size = 0, members = 0;
};

/// Inflates gzip of one or more members (RFC 1952 2.2) into `sink`, consuming `bytes`. Error 422 about
/// `path`: not gzip, truncated, a bad checksum, data after the last member. 413: over `most` inflated bytes.
icd::Checked<Gunzipped> gunzip(icd::ChunkedBytes bytes, std::size_t most, std::string_view path,
                               const Sink& sink);

/// Levels of libdeflate; 1 is the fastest. 6 compresses like zlib's 6 in a third of the time. Levels from 10
/// on are smaller than any of zlib's, and slow.
inline constexpr int kFastestLevel = 1, kSmallestLevel = 12;

/// One gzip member (RFC 1952) of contiguous bytes, without time or name in its header. std::nullopt if it
/// would exceed `most` bytes, which mostly shows early. `level`: kFastestLevel to kSmallestLevel.
///
/// Takes at most `most` bytes for the member, which is not copied, and temporarily 1 MiB at levels up to 9, 9
/// MiB above. For data in pieces, use Gzipper. CPU time grows with the size of `bytes`.
std::optional<icd::ChunkedBytes> gzip(std::span<const std::uint8_t> bytes, int level, std::size_t most);

/// The `size` bytes of exactly one gzip member, in a tenth of gunzip()'s time for a grid. std::nullopt:
/// invalid, damaged, or another size. Takes `size` bytes of memory, and a copy of a member in several chunks.
std::optional<std::vector<std::uint8_t>> gunzip(const icd::ChunkedBytes& member, std::size_t size);

/// Passes a map's data, inflated if compressed, to `sink` in pieces of at most icd::ChunkedBytes::kChunk. An
/// error is about the data, or from `sink`.
icd::Checked<void> for_each_piece(const icd::MapData& data, const Sink& sink);

}  // namespace adit::codec
