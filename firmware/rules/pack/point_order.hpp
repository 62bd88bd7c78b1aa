#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "pack/coordinates.hpp"

namespace adit::pack {

/// The order of points: by one coordinate first. gzip makes them smaller, because neighbours then have
/// similar bytes.
enum class Layers : std::uint8_t {
  AlongX,  // by x, then z, then y
  AlongY,  // by y, then x, then z
  AlongZ,  // by z, then y, then x
};

/// Maximum number of points to order at once. It bounds the memory to 24 bytes a point.
inline constexpr std::size_t kMostOrdered = std::size_t{1} << 19;

/// The numbers of the points in that order. Points that are equal in it keep their order. `points`: at most
/// kMostOrdered points of point_step bytes, all within `box`. The first coordinate is compared by 22 bits of
/// the box's size, the others by 11. The values serve only to order the points.
std::vector<std::uint32_t> numbers_in(Layers layers, const icd::PointCloud2& cloud, const Box& box,
                                      std::span<const std::uint8_t> points);

}  // namespace adit::pack
