#include "queues/lattice.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

#include "icd/placement.hpp"

namespace adit::queues {
namespace {

/// Origins are compared in thousandths of a cell, because a multiple of the resolution (a float32 in ROS) has
/// rounding errors. Both are rounded to these steps; with a tolerance, a chain of lattices could drift.
constexpr std::int64_t kStepsPerCell = 1000;
/// Larger doubles cannot express thousandths.
constexpr double kMostSteps = 9007199254740992.0;

/// The position of a grid's lower left corner, in steps along the grid's own axes.
struct Corner {
  std::int64_t x = 0, y = 0, z = 0;
};

/// An origin's position along its own axes: the product of the transposed rotation matrix and the position.
icd::Point turned_back(const icd::Pose& origin) {
  const auto& [turn, p] = icd::Placement{origin};
  return {turn[0][0] * p.x + turn[1][0] * p.y + turn[2][0] * p.z,
          turn[0][1] * p.x + turn[1][1] * p.y + turn[2][1] * p.z,
          turn[0][2] * p.x + turn[1][2] * p.y + turn[2][2] * p.z};
}

/// Nothing if the grid is so far away that doubles cannot distinguish its cells.
std::optional<Corner> corner_of(const icd::OccupancyGrid& grid) {
  const icd::Point p = turned_back(grid.origin);
  const double scale = static_cast<double>(kStepsPerCell) / grid.resolution;
  const double x = p.x * scale, y = p.y * scale, z = p.z * scale;
  const auto tellable = [](double steps) { return std::abs(steps) < kMostSteps; };  // false for NaN
  if (!tellable(x) || !tellable(y) || !tellable(z)) return {};
  return Corner{std::llround(x), std::llround(y), std::llround(z)};
}

/// Steps as cells; nothing if they are not a whole number of cells.
std::optional<std::int64_t> whole_cells(std::int64_t steps) {
  if (steps % kStepsPerCell != 0) return {};
  return steps / kStepsPerCell;
}

Cells cells_at(std::int64_t x, std::int64_t y, const icd::OccupancyGrid& grid) {
  return {x, y, grid.width, grid.height};
}

}  // namespace

std::optional<Cells> cells_in(const icd::OccupancyGrid& of, const icd::OccupancyGrid& grid) {
  if (grid.resolution != of.resolution || grid.origin.orientation != of.origin.orientation) {
    return {};
  }
  const auto from = corner_of(of), to = corner_of(grid);
  if (!from || !to) return of.origin == grid.origin ? std::optional(cells_at(0, 0, grid)) : std::nullopt;
  const auto x = whole_cells(to->x - from->x), y = whole_cells(to->y - from->y);
  if (!x || !y || to->z != from->z) return {};
  return cells_at(*x, *y, grid);
}

/// In the middle of its step, so that rounding errors do not change the step.
std::optional<icd::Pose> corner_at(const icd::OccupancyGrid& of, std::int64_t x, std::int64_t y) {
  const auto from = corner_of(of);
  if (!from) return {};
  const double step = of.resolution / static_cast<double>(kStepsPerCell);
  const icd::Point there{static_cast<double>(from->x + x * kStepsPerCell) * step,
                         static_cast<double>(from->y + y * kStepsPerCell) * step, turned_back(of.origin).z};
  const icd::Placement turned{{.position = {}, .orientation = of.origin.orientation}};
  return icd::Pose{turned(there), of.origin.orientation};
}

}  // namespace adit::queues
