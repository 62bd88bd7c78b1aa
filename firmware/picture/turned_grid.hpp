#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "icd/map_update.hpp"
#include "icd/placement.hpp"
#include "picture/sheet.hpp"

namespace adit::picture {

/// Draws a grid that lies askew, cell by cell: the pixel in which a cell's centre lies, or, where cells are
/// not much smaller than pixels, those of as many points evenly over the cell as leave no gap.
class TurnedGrid {
 public:
  TurnedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet);

  /// A part of a row, in the order of the data.
  void draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells);
  std::size_t left_out() const { return left_out_; }

 private:
  struct Step {
    double x = 0, y = 0;  // in pixels
  };
  bool is_near(double x, double y) const;
  void dab(double x, double y, std::uint8_t index);

  Sheet& sheet_;
  Step origin_, column_, row_;  // where the grid's corner lies, and what one cell more adds
  double reach_ = 0;            // of a cell around its centre
  int side_ = 1;                // points along a cell's side; 0: cells are too large to be drawn
  std::size_t dabs_ = 0;
  std::size_t left_out_ = 0;
};

}  // namespace adit::picture
