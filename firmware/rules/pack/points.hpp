#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::pack {

/// x, y and z of a point, in metres, in the frame of its cloud.
using Coordinates = std::array<double, 3>;

/// Reads the coordinates of a cloud's points: float32 or float64 in either byte order (ICD 6.3.2).
class CoordinateReader {
 public:
  /// Of a cloud with x, y and z (icd::axes_of()).
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

/// Calls `visit` with each point (point_step bytes), in order, across chunk borders, until it returns false.
template <class Visit>
void for_each_point(const icd::ChunkedBytes& bytes, std::size_t point_step, Visit visit) {
  std::vector<std::uint8_t> cut;  // the first bytes of a point that continues in the next chunk
  for (const auto& chunk : bytes.chunks()) {
    std::span<const std::uint8_t> rest{*chunk};
    if (!cut.empty()) {
      const auto more = rest.first(std::min(rest.size(), point_step - cut.size()));
      cut.insert(cut.end(), more.begin(), more.end());
      rest = rest.subspan(more.size());
      if (cut.size() < point_step) continue;
      if (!visit(std::span<const std::uint8_t>{cut})) return;
      cut.clear();
    }
    for (; rest.size() >= point_step; rest = rest.subspan(point_step)) {
      if (!visit(rest.first(point_step))) return;
    }
    cut.assign(rest.begin(), rest.end());
  }
}

/// The points of uncompressed `data` for which `stays` returns true, unchanged, in their order.
template <class Stays>
icd::MapData filter_points(const icd::MapData& data, std::size_t point_step, Stays stays) {
  icd::MapData kept;
  for_each_point(data.bytes, point_step, [&](std::span<const std::uint8_t> point) {
    if (stays(point)) kept.bytes.append(point);
    return true;
  });
  kept.raw_size = kept.bytes.size();
  return kept;
}

/// The layout of a cloud's points, and how to copy points of another layout into it.
struct PointLayout {
  /// Adjacent bytes of a point that are copied together.
  struct Run {
    std::uint32_t from = 0, to = 0, size = 0;
  };

  icd::PointCloud2 cloud;
  std::vector<Run> runs;  // they cover each byte that is kept

  /// Copies a point from the old layout to the new one.
  void copy(std::span<const std::uint8_t> point, std::span<std::uint8_t> to) const;
};

/// The layout of `cloud`; each point is copied whole.
PointLayout plain_layout(const icd::PointCloud2& cloud);

/// The layout without the padding between and after the fields. The fields keep their bytes, their places in
/// the list and their order. nullopt if two fields share a byte. Requires check(cloud).
std::optional<PointLayout> strip_padding(const icd::PointCloud2& cloud);

}  // namespace adit::pack
