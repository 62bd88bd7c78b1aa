#include "pack/rounding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/placement.hpp"
#include "pack/coordinates.hpp"
#include "pack/point_layout.hpp"

namespace adit::pack {
namespace {

/// Fields whose values do not change when the cloud is turned.
constexpr std::string_view kUnturned[] = {"intensity", "i",    "rgb", "rgba",      "ring",  "reflectivity",
                                          "label",     "time", "t",   "timestamp", "range", "ambient"};

bool is_coordinate(const icd::FieldSchema& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

bool may_be_turned(const icd::PointCloud2& cloud) {
  return std::ranges::all_of(cloud.fields, [](const icd::FieldSchema& field) {
    return is_coordinate(field) || std::ranges::find(kUnturned, field.name) != std::end(kUnturned);
  });
}

bool is_turned(const icd::Quaternion& q) {
  return q.x != 0 || q.y != 0 || q.z != 0;
}

/// The box that holds all corners of the placed `box`.
Box placed_box(const Box& box, const icd::Placement& placed) {
  Box all;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto end = [&](unsigned axis) {
      return (corner >> axis & 1) != 0 ? box.high[axis] : box.low[axis];
    };
    const icd::Point at = placed({end(0), end(1), end(2)});
    all.add({at.x, at.y, at.z});
  }
  return all;
}

/// Leads from the points' frame into the binade; `origin` leads from there to "darpa".
struct Shift {
  icd::Placement placed;
  icd::Point origin;
};

/// Moves one coordinate of `placed` so that `low` to `high` lie in the binade. False if the binade is too
/// narrow or float32 too coarse in "darpa". `origin` is a float32, so a receiver rounds only once, when it
/// adds the two.
bool shift(double binade, double unit, double low, double high, double& placed, double& origin) {
  constexpr double kMargin = 4;  // units; the origin is rounded by at most one
  if (!(std::max(std::abs(low), std::abs(high)) < binade)) return false;
  origin = static_cast<double>(static_cast<float>(low - binade - kMargin * unit));
  placed -= origin;
  return low - origin >= binade && high - origin <= 2 * binade - unit;
}

std::optional<Shift> shift_of(const icd::PointCloud2& cloud, const Box& box, double unit) {
  const icd::Pose origin = cloud.origin.value_or(icd::Pose{});
  if (is_turned(origin.orientation) && !may_be_turned(cloud)) return std::nullopt;
  Shift found{.placed = icd::Placement{origin}, .origin = {}};
  const Box all = placed_box(box, found.placed);
  const double binade = 0x1p23 * unit;
  icd::Point& by = found.placed.shift;
  const bool fits = shift(binade, unit, all.low[0], all.high[0], by.x, found.origin.x) &&
                    shift(binade, unit, all.low[1], all.high[1], by.y, found.origin.y) &&
                    shift(binade, unit, all.low[2], all.high[2], by.z, found.origin.z);
  return fits ? std::optional(found) : std::nullopt;
}

icd::PointCloud2 in_float32(icd::PointCloud2 cloud) {
  for (icd::FieldSchema& field : cloud.fields) {
    if (is_coordinate(field)) field.datatype = icd::Datatype::Float32;
  }
  return cloud;
}

/// Works in place, because the new points are not larger.
void shift_points(Arranged& arranged, const PointLayout& layout, const icd::Placement& placed) {
  const CoordinateReader coordinates{arranged.cloud};
  const auto axes = axes_of(layout.cloud);
  const std::size_t step = arranged.cloud.point_step, new_step = layout.cloud.point_step;
  std::vector<std::uint8_t> point(step);
  std::size_t end = 0;  // of the new points
  for (std::size_t from = 0; from < arranged.points.size(); from += step) {
    std::memcpy(point.data(), arranged.points.data() + from, step);
    const std::span<std::uint8_t> to = std::span{arranged.points}.subspan(end, new_step);
    layout.copy(point, to);
    const auto [x, y, z] = coordinates(point);
    const icd::Point at = placed({x, y, z});
    for (const auto& [metres, axis] : {std::pair{at.x, axes[0]}, {at.y, axes[1]}, {at.z, axes[2]}}) {
      const auto rounded = static_cast<float>(metres);
      std::memcpy(to.data() + axis, &rounded, sizeof rounded);
    }
    end += new_step;
  }
  arranged.points.resize(end);
}

}  // namespace

bool round_to(double unit, Arranged& arranged) {
  if (arranged.cloud.is_bigendian || arranged.points.empty()) return false;
  const auto layout = without_padding(in_float32(arranged.cloud));
  const auto shift = shift_of(arranged.cloud, box_of(arranged), unit);
  if (!layout || !shift) return false;
  shift_points(arranged, *layout, shift->placed);
  arranged.cloud = layout->cloud;
  arranged.cloud.origin = icd::Pose{.position = shift->origin, .orientation = {}};
  return true;
}

}  // namespace adit::pack
