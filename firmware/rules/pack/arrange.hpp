#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "icd/map_update.hpp"
#include "pack/coordinates.hpp"
#include "pack/point_layout.hpp"

namespace adit::pack {

/// libdeflate's level for points. Level 6 takes a quarter longer and saves up to 2 %. The output of level 4
/// is up to a third larger.
inline constexpr int kPointsLevel = 5;

/// A cloud whose points are uncompressed and in one piece.
struct Arranged {
  icd::PointCloud2 cloud;
  std::vector<std::uint8_t> points;
};

/// Copies the uncompressed points of `data`, each of `point_step` bytes, into `layout`, in their order.
Arranged in_one_piece(const PointLayout& layout, const icd::MapData& data, std::size_t point_step);

/// The box of all its points.
Box box_of(const Arranged& arranged);

/// Puts the points in the order in which gzip makes them smallest: in layers along one of the axes, or as
/// they are. Each order is tried on a sample, and at most kMostOrdered points are ordered at a time. Nothing
/// is lost, because a cloud is a set of points (ICD 6.3.2: "clouds will always be unstructured").
void put_in_order(Arranged& arranged);

}  // namespace adit::pack
