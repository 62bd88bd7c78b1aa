#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "pack/box.hpp"

namespace adit::pack {

/// Points in layers: by one coordinate first. Neighbours are then alike in its bytes, so that gzip makes them
/// smaller.
enum class Layers : std::uint8_t {
  AlongX,  // by x, then z, then y
  AlongY,  // by y, then x, then z
  AlongZ,  // by z, then y, then x
};

/// So many points are put in order at once, at most: it bounds the memory for it to 24 bytes a point.
inline constexpr std::size_t kMostOrdered = std::size_t{1} << 19;

/// The numbers of the points in that order; of points that are alike in it, in the order they have. `points`:
/// of point_step bytes, kMostOrdered of them at most, all within `box`. Coordinates are told apart by 22 bits
/// of the box's size (the first) and by 11 (the others): nothing but their order hangs on it.
std::vector<std::uint32_t> numbers_in(Layers layers, const icd::PointCloud2& cloud, const Box& box,
                                      std::span<const std::uint8_t> points);

}  // namespace adit::pack
