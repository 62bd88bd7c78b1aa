#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "icd/map_update.hpp"

namespace adit::picture {

/// Cuts a cloud's data into points, piece by piece. Calls `visit(bytes)` with the first of every `stride`
/// points.
class PointCutter {
 public:
  PointCutter(std::size_t point_step, std::size_t stride) : step_(point_step), stride_(stride) {}

  template <class Visit>
  void feed(std::span<const std::uint8_t> piece, Visit visit) {
    if (!cut_.empty()) {
      const auto more = piece.first(std::min(piece.size(), step_ - cut_.size()));
      cut_.insert(cut_.end(), more.begin(), more.end());
      piece = piece.subspan(more.size());
      if (cut_.size() < step_) return;
      give(cut_.data(), visit);
      cut_.clear();
    }
    for (; piece.size() >= step_; piece = piece.subspan(step_)) give(piece.data(), visit);
    cut_.assign(piece.begin(), piece.end());
  }

 private:
  template <class Visit>
  void give(const std::uint8_t* point, Visit& visit) {
    if (number_ == 0) visit(point);
    if (++number_ == stride_) number_ = 0;
  }

  std::size_t step_, stride_, number_ = 0;
  std::vector<std::uint8_t> cut_;  // the first bytes of a point that continues in the next piece
};

/// Reads one coordinate of a point.
template <class Float, bool Bigendian>
Float coordinate(const std::uint8_t* at) {
  static_assert(std::endian::native == std::endian::little);
  std::array<std::uint8_t, sizeof(Float)> bytes;
  std::memcpy(bytes.data(), at, sizeof(Float));
  if constexpr (Bigendian) std::ranges::reverse(bytes);
  return std::bit_cast<Float>(bytes);
}

}  // namespace adit::picture
