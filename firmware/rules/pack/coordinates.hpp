#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "icd/map_update.hpp"

namespace adit::pack {

/// x, y and z of a point, in metres, in the frame of its cloud.
using Coordinates = std::array<double, 3>;

/// The offsets of x, y and z in a point of a cloud that check() accepts.
std::array<std::size_t, 3> axes_of(const icd::PointCloud2& cloud);

/// Reads the coordinates of a cloud's points: float32 or float64 in either byte order (ICD 6.3.2).
class CoordinateReader {
 public:
  /// Requires check(cloud).
  explicit CoordinateReader(const icd::PointCloud2& cloud);

  /// `point` has point_step bytes.
  Coordinates operator()(std::span<const std::uint8_t> point) const {
    Coordinates read{};
    for (std::size_t axis = 0; axis < read.size(); ++axis) {
      const std::uint8_t* const at = point.data() + offsets_[axis];
      read[axis] = is_double_ ? value<double, std::uint64_t>(at) : value<float, std::uint32_t>(at);
    }
    return read;
  }

 private:
  template <class Float, class Bits>
  double value(const std::uint8_t* at) const {
    static_assert(std::endian::native == std::endian::little);
    Bits bits = 0;
    std::memcpy(&bits, at, sizeof bits);
    return std::bit_cast<Float>(is_bigendian_ ? std::byteswap(bits) : bits);
  }

  std::array<std::size_t, 3> offsets_;
  bool is_double_, is_bigendian_;
};

/// The smallest axis-parallel box around some points. Without points its low is above its high.
struct Box {
  Coordinates low = all(std::numeric_limits<double>::max()),
              high = all(std::numeric_limits<double>::lowest());

  void add(const Coordinates& point) {
    for (std::size_t axis = 0; axis < point.size(); ++axis) {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }

 private:
  static Coordinates all(double metres) { return {metres, metres, metres}; }
};

}  // namespace adit::pack
