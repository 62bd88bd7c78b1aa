#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/mapping.hpp"
#include "pack/points.hpp"

namespace adit::pack {

/// The order of points, by one coordinate first. Neighbours then have similar bytes, which gzip makes small.
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

/// libdeflate's level for points. 6 takes a quarter longer and saves up to 2 %; 4 is up to a third larger.
inline constexpr int kPointsLevel = 5;

/// A cloud whose points are uncompressed and in one piece.
struct ContiguousCloud {
  icd::PointCloud2 cloud;
  std::vector<std::uint8_t> points;
};

/// Copies the uncompressed points of `data`, each of `point_step` bytes, into `layout`, in their order.
ContiguousCloud arrange_contiguous(const PointLayout& layout, const icd::MapData& data,
                                   std::size_t point_step);

Box box_of(const ContiguousCloud& arranged);

/// Puts the points in the order in which gzip makes them smallest: in layers along one of the axes, or as
/// they are. Each order is tried on a sample, and at most kMostOrdered points are ordered at a time. Nothing
/// is lost, because a cloud is a set of points (ICD 6.3.2: "clouds will always be unstructured").
void put_in_order(ContiguousCloud& arranged);

/// Rounds x, y and z to whole steps of `unit` metres, a power of two, so that gzip makes them small. Each
/// coordinate is shifted into the binade of float32 whose steps these are (from 2^23 steps up), because all
/// numbers there have the same exponent. The cloud's origin takes the shift back. float64 becomes float32;
/// other fields keep their bits. If the origin turns the cloud, the points are turned here instead, because
/// turning such large numbers in float32 at the receiver would lose more than the rounding.
///
/// Each point stays within 1.3 units of its place in "darpa", even if the receiver computes in float32. If
/// that is not possible, it returns false and changes nothing:
/// - the points extend over more than the binade, or lie that far from "darpa"'s origin (8192 m for 2^-10 m)
/// - the cloud is turned and has fields that may contain a direction
/// - the cloud is big-endian, because a server may object to an origin then
/// - two fields share bytes, or there are no points
/// All points are finite (remove_invalid_points()).
bool round_to(double unit, ContiguousCloud& arranged);

}  // namespace adit::pack
