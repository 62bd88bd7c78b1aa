#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"

namespace adit::codec {

enum class GzipStrategy : std::uint8_t {
  Default,  // zlib level 6: for text
  Runs,     // zlib level 6 with Z_RLE: for grids, two to five times faster and mostly smaller
};

/// Makes one gzip member (RFC 1952) of what it is fed, with nothing after it, and no time or name in its
/// header.
class Gzipper {
 public:
  explicit Gzipper(GzipStrategy strategy);
  ~Gzipper();
  Gzipper(Gzipper&&) noexcept;
  Gzipper& operator=(Gzipper&&) noexcept;

  void feed(std::span<const std::uint8_t> bytes);
  /// How much take_some() would give.
  std::size_t held() const { return member_.size(); }
  /// What has come of the member since the last take_some(), in whole chunks.
  icd::ChunkedBytes take_some() { return std::move(member_); }
  /// The whole member, or what take_some() has left of it, once, after the last feed.
  icd::ChunkedBytes finish();

 private:
  struct Stream;
  void deflate_with(int flush);
  void give_piece();

  std::unique_ptr<Stream> stream_;
  std::vector<std::uint8_t> piece_;  // what comes out, until it is a whole chunk...
  std::size_t made_ = 0;             // ...and so much of it has
  icd::ChunkedBytes member_;
};

/// One gzip member with nothing after it. `bytes` is consumed chunk by chunk.
icd::ChunkedBytes gzip(icd::ChunkedBytes bytes, GzipStrategy strategy);

/// The size that the last gzip member claims (ISIZE, RFC 1952 2.3.1, modulo 2^32). It is right if gunzip()
/// has passed the member. 0 if `bytes` are too short for the claim.
std::size_t claimed_size(const icd::ChunkedBytes& bytes);

/// Takes what was inflated, piece by piece, and may refuse it.
using Sink = std::function<icd::Checked<void>(std::span<const std::uint8_t>)>;

/// The number of bytes after inflating, and the number of members.
struct Gunzipped {
  std::size_t size = 0, members = 0;
};

/// Inflates gzip, one member or several (RFC 1952 2.2), into `sink`, consuming `bytes`. Refuses, with 422
/// about the field at `path`, bytes that are not gzip, end early, have a bad checksum, or continue after the
/// last member with anything else; with 413, more than `most` bytes after inflating.
icd::Checked<Gunzipped> gunzip(icd::ChunkedBytes bytes, std::size_t most, std::string_view path,
                               const Sink& sink);

}  // namespace adit::codec
