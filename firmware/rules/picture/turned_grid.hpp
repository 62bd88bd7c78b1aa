#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "icd/map_update.hpp"
#include "icd/placement.hpp"
#include "picture/sheet.hpp"

namespace adit::picture {

/// Draws a rotated grid cell by cell. A small cell sets the pixel at its centre. A larger cell sets the
/// pixels of several points, evenly spread over the cell so that no gaps are left.
class TurnedGrid {
 public:
  TurnedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet);

  /// Draws a part of a row. Call it in the order of the data.
  void draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells);
  std::size_t left_out() const { return left_out_; }

 private:
  struct Step {
    double x = 0, y = 0;  // in pixels
  };
  bool is_near(double x, double y) const;
  void dab(double x, double y, std::uint8_t index);

  Sheet& sheet_;
  Step origin_, column_, row_;  // the grid's corner, and the steps from cell to cell
  double reach_ = 0;            // from a cell's centre to its corner, in pixels
  int side_ = 1;                // points along a cell's side; 0: cells are too large to be drawn
  std::size_t dabs_ = 0;
  std::size_t left_out_ = 0;
};

}  // namespace adit::picture
