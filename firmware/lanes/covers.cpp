#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "lanes/map_lane.hpp"

namespace adit::lanes {
namespace {

/// An origin is compared in thousandths of a cell, so that what floating point makes of a multiple of the
/// resolution (ROS sends it as a float32) is one lattice still. Rounding both to these steps, instead of
/// allowing a difference, keeps `covers` transitive.
constexpr std::int64_t kStepsPerCell = 1000;
/// Above it a double has no thousandths left.
constexpr double kMostSteps = 9007199254740992.0;

/// Where a grid's lower left corner lies, in steps along the grid's own axes.
struct Corner {
  std::int64_t x = 0, y = 0, z = 0;
};

icd::Quaternion normalized(icd::Quaternion q) {
  const double largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)});
  q = {q.x / largest, q.y / largest, q.z / largest, q.w / largest};  // so that squares stay in range
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / norm, q.y / norm, q.z / norm, q.w / norm};
}

/// `p` in the frame that `orientation` turns to: the product of the transposed rotation matrix and `p`.
icd::Point turned_back(const icd::Quaternion& orientation, const icd::Point& p) {
  const auto [x, y, z, w] = normalized(orientation);
  return {(1 - 2 * (y * y + z * z)) * p.x + 2 * (x * y + w * z) * p.y + 2 * (x * z - w * y) * p.z,
          2 * (x * y - w * z) * p.x + (1 - 2 * (x * x + z * z)) * p.y + 2 * (y * z + w * x) * p.z,
          2 * (x * z + w * y) * p.x + 2 * (y * z - w * x) * p.y + (1 - 2 * (x * x + y * y)) * p.z};
}

/// Nothing where the grid lies so far out that its cells cannot be told apart.
std::optional<Corner> corner_of(const icd::OccupancyGrid& grid) {
  const icd::Point p = turned_back(grid.origin.orientation, grid.origin.position);
  const double scale = static_cast<double>(kStepsPerCell) / grid.resolution;
  const double x = p.x * scale, y = p.y * scale, z = p.z * scale;
  const auto tellable = [](double steps) {
    return std::abs(steps) < kMostSteps;
  };  // false for what is no number
  if (!tellable(x) || !tellable(y) || !tellable(z)) return {};
  return Corner{std::llround(x), std::llround(y), std::llround(z)};
}

/// Whether `size` cells that begin at `begin` lie within `outer_size` cells that begin at `outer_begin`.
bool within(std::int64_t begin, std::int64_t size, std::int64_t outer_begin, std::int64_t outer_size) {
  const std::int64_t steps = begin - outer_begin;
  if (steps < 0 || steps % kStepsPerCell != 0) return false;
  return steps / kStepsPerCell + size <= outer_size;
}

}  // namespace

bool covers(const icd::OccupancyGrid& newer, const icd::OccupancyGrid& older) {
  if (newer.resolution != older.resolution || newer.origin.orientation != older.origin.orientation) {
    return false;
  }
  const auto outer = corner_of(newer), inner = corner_of(older);
  if (!outer || !inner) {
    return newer.origin == older.origin && older.width <= newer.width && older.height <= newer.height;
  }
  return inner->z == outer->z && within(inner->x, older.width, outer->x, newer.width) &&
         within(inner->y, older.height, outer->y, newer.height);
}

}  // namespace adit::lanes
