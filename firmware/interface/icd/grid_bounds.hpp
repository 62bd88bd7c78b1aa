#pragma once

#include <optional>

#include "icd/geometry.hpp"
#include "icd/mapping.hpp"

namespace adit::icd {

/// The box around a grid and around all grids that it replaced. It lies along the grid's axes. Without it, a
/// grid that moves by less than half a cell each time would lose older area bit by bit.
struct GridBounds {
  Pose origin;            // of the grid
  double resolution = 0;  // metres a cell, of all of them
  Point low, high;        // corners, in metres from the origin along the grid's axes
  double turned = 0;      // metres by which the turns between the grids moved a corner, in all

  /// The box around the grid alone.
  static GridBounds from_grid(const OccupancyGrid& grid);
  /// Whether it is larger than `grid`, to which it belongs, by more than a rounding error.
  bool is_larger_than(const OccupancyGrid& grid) const;
  friend bool operator==(const GridBounds&, const GridBounds&) = default;
};

/// Whether `newer` contains all cells of `older`, the bounds of an older grid of the same name, so that the
/// older one need not be sent (ICD 6.3.1, promise 2). Both have cells of one size. The bounds lie within the
/// newer grid, to half a cell on each side and in height. The turns between the grids move no corner by more
/// than half a cell. The two may have different lattices, because SLAM corrects the map's frame.
bool covers(const OccupancyGrid& newer, const GridBounds& older);

/// Two corners of a box, in metres along the axes of a grid.
struct PartOfGrid {
  Point low, high;
};
/// The part of `older` that `newer` covers, the bounds of one newer grid, as covers() would say it of a grid
/// of that part. It may reach beyond `older`. Nothing: their resolution, height or direction differs.
std::optional<PartOfGrid> covered_part(const GridBounds& newer, const OccupancyGrid& older);

/// The bounds of a grid that replaces another: `newer`, enlarged so that it holds `older`.
GridBounds joint_bounds(const GridBounds& newer, const GridBounds& older);

}  // namespace adit::icd
