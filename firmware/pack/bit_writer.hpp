#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "icd/chunked_bytes.hpp"

namespace adit::pack {

/// Bits, the first one lowest in its byte (RFC 1951 3.1.1), to the end of `out`, which outlives it.
class BitWriter {
 public:
  explicit BitWriter(icd::ChunkedBytes& out) : out_(out) {}

  /// At most 48 bits, of which no other is set in `bits`.
  void put(std::uint64_t bits, unsigned count) {
    held_ |= bits << held_bits_;
    held_bits_ += count;
    if (room_.size() - used_ < sizeof held_) write_out();
    std::memcpy(room_.data() + used_, &held_, sizeof held_);
    used_ += held_bits_ / 8;
    held_ >>= held_bits_ & ~7U;
    held_bits_ &= 7U;
  }
  /// Fills the last byte with zeros, and writes all out.
  void finish() {
    put(0, (8 - held_bits_) & 7U);
    write_out();
  }

 private:
  void write_out() {
    out_.append({room_.data(), used_});
    used_ = 0;
  }

  icd::ChunkedBytes& out_;
  std::vector<std::uint8_t> room_ = std::vector<std::uint8_t>(4096);
  std::size_t used_ = 0;
  std::uint64_t held_ = 0;  // fewer than 8 bits between two calls
  unsigned held_bits_ = 0;
};

}  // namespace adit::pack
