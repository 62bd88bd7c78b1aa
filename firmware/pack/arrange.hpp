#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "icd/map_update.hpp"
#include "pack/box.hpp"
#include "pack/point_layout.hpp"

namespace adit::pack {

/// Of libdeflate, by which points are compressed: 6 is a quarter slower and up to 2 % smaller, 4 is
/// up to a third larger.
inline constexpr int kPointsLevel = 5;

/// A cloud with all its points in one piece, not compressed.
struct Arranged {
  icd::PointCloud2 cloud;
  std::vector<std::uint8_t> points;
};

/// The points of `data`, not compressed, of `point_step` bytes, laid out in that way, in their order.
Arranged in_one_piece(const PointLayout& layout, const icd::MapData& data, std::size_t point_step);

/// Of all its points.
Box box_of(const Arranged& arranged);

/// Puts the points in the order in which gzip makes them smallest: in layers along one of the axes, or as
/// they are. A part of them is tried in each order, and kMostOrdered points are ordered at a time. A cloud is
/// a set of points (ICD 6.3.2: "clouds will always be unstructured"), so that this loses nothing.
void put_in_order(Arranged& arranged);

}  // namespace adit::pack
