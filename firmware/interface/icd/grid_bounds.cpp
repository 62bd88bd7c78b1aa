#include "icd/grid_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "icd/geometry.hpp"
#include "icd/mapping.hpp"
#include "icd/rules.hpp"
#include "icd/sentence.hpp"

namespace adit::icd {
namespace {

bool is_bad(std::uint8_t cell) {
  return cell > kMostOccupied && cell != kUnknownCell;
}

}  // namespace

std::size_t sound_cells(std::span<const std::uint8_t> cells) {
  std::uint8_t bad = 0;  // compilers vectorize this loop because it has no early exit
  for (const std::uint8_t cell : cells) bad |= static_cast<std::uint8_t>(is_bad(cell) ? 1 : 0);
  if (bad == 0) return cells.size();
  return static_cast<std::size_t>(std::ranges::find_if(cells, is_bad) - cells.begin());
}

Checked<void> check_cells(std::span<const std::uint8_t> cells, std::size_t first) {
  const std::size_t sound = sound_cells(cells);
  if (sound == cells.size()) return {};
  return unprocessable("msg.data[", first + sound, "]: expected 0 to 100 or 255, got ", +cells[sound]);
}

namespace {

/// Cells by which positions may differ because of rounding: a resolution is a float32 in ROS.
constexpr double kRounding = 1e-3;

/// Metres by which an older grid may reach out of a newer one.
double slack_of(double resolution) {
  return resolution * (0.5 + kRounding);
}

/// Bounds along other axes.
struct AlignedBounds {
  Point low, high;
  double turn = 0;  // metres by which the turn moves a corner, if the middle stays
};

using Matrix = std::array<std::array<double, 3>, 3>;

Point rotate(const Matrix& by, const Point& p) {
  return {by[0][0] * p.x + by[0][1] * p.y + by[0][2] * p.z, by[1][0] * p.x + by[1][1] * p.y + by[1][2] * p.z,
          by[2][0] * p.x + by[2][1] * p.y + by[2][2] * p.z};
}

Matrix transpose(const Matrix& m) {
  return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix all{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      for (std::size_t i = 0; i < 3; ++i) all[row][column] += a[row][i] * b[i][column];
    }
  }
  return all;
}

double length(const Point& p) {
  return std::hypot(p.x, p.y, p.z);
}

Point translate(const Point& p, const Point& by, double times = 1) {
  return {p.x + times * by.x, p.y + times * by.y, p.z + times * by.z};
}

/// `box` along the axes of `axes`, from its origin.
AlignedBounds relative_bounds(const Pose& axes, const GridBounds& box) {
  const Placement there{axes};
  const Matrix back = transpose(there.turn);
  const Point shift = rotate(back, translate(box.origin.position, there.shift, -1));
  if (axes.orientation == box.origin.orientation)
    return {translate(box.low, shift), translate(box.high, shift), 0};
  const Matrix turn = product(back, Placement{box.origin}.turn);
  const Point half = {(box.high.x - box.low.x) / 2, (box.high.y - box.low.y) / 2,
                      (box.high.z - box.low.z) / 2};
  const Point middle = translate(rotate(turn, translate(box.low, half)), shift);
  AlignedBounds seen{middle, middle, 0};
  for (const double x : {-half.x, half.x}) {
    for (const double y : {-half.y, half.y}) {
      for (const double z : {-half.z, half.z}) {
        const Point before{x, y, z}, after = rotate(turn, before), corner = translate(middle, after);
        seen.low = {std::min(seen.low.x, corner.x), std::min(seen.low.y, corner.y),
                    std::min(seen.low.z, corner.z)};
        seen.high = {std::max(seen.high.x, corner.x), std::max(seen.high.y, corner.y),
                     std::max(seen.high.z, corner.z)};
        seen.turn = std::max(seen.turn, length(translate(after, before, -1)));
      }
    }
  }
  return seen;
}

/// Whether the origin of `older` is certainly outside `newer`. Much cheaper than relative_bounds(), because
/// each new grid is compared with each queued grid of its name.
bool is_far(const OccupancyGrid& newer, const Pose& older) {
  const Point between = translate(newer.origin.position, older.position, -1);
  const double most = (1.0 + newer.width + newer.height) * newer.resolution;
  return between.x * between.x + between.y * between.y + between.z * between.z > most * most;
}

/// False for NaN.
bool is_within(double low, double high, double length, double slack) {
  return low >= -slack && high <= length + slack;
}

}  // namespace

GridBounds GridBounds::from_grid(const OccupancyGrid& grid) {
  return {.origin = grid.origin,
          .resolution = grid.resolution,
          .low = {},
          .high = {grid.width * grid.resolution, grid.height * grid.resolution, 0}};
}

bool GridBounds::is_larger_than(const OccupancyGrid& grid) const {
  const double rounding = kRounding * resolution;
  return !is_within(low.x, high.x, grid.width * resolution, rounding) ||
         !is_within(low.y, high.y, grid.height * resolution, rounding) ||
         !is_within(low.z, high.z, 0, rounding) || turned > rounding;
}

bool covers(const OccupancyGrid& newer, const GridBounds& older) {
  if (newer.resolution != older.resolution || is_far(newer, older.origin)) return false;
  const double slack = slack_of(newer.resolution);
  const AlignedBounds seen = relative_bounds(newer.origin, older);
  return is_within(seen.low.x, seen.high.x, newer.width * newer.resolution, slack) &&
         is_within(seen.low.y, seen.high.y, newer.height * newer.resolution, slack) &&
         is_within(seen.low.z, seen.high.z, 0, slack) && older.turned + seen.turn <= slack;
}

std::optional<PartOfGrid> covered_part(const GridBounds& newer, const OccupancyGrid& older) {
  if (newer.resolution != older.resolution) return {};
  const double slack = slack_of(older.resolution);
  const AlignedBounds seen = relative_bounds(older.origin, newer);
  if (!is_within(seen.low.z, seen.high.z, 0, slack) || !(seen.turn <= slack)) return {};
  return PartOfGrid{seen.low, seen.high};
}

GridBounds joint_bounds(const GridBounds& newer, const GridBounds& older) {
  const AlignedBounds seen = relative_bounds(newer.origin, older);
  GridBounds all = newer;
  all.low = {std::min(newer.low.x, seen.low.x), std::min(newer.low.y, seen.low.y),
             std::min(newer.low.z, seen.low.z)};
  all.high = {std::max(newer.high.x, seen.high.x), std::max(newer.high.y, seen.high.y),
              std::max(newer.high.z, seen.high.z)};
  all.turned = std::max(newer.turned, older.turned + seen.turn);
  return all;
}

}  // namespace adit::icd
