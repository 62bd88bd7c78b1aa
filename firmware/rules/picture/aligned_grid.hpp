#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/placement.hpp"
#include "picture/sheet.hpp"

namespace adit::picture {

/// Draws a grid whose rows run along x, as most do. A pixel shows the cells whose centres lie in it. If cells
/// are larger than pixels, it shows the cell that contains the pixel's centre.
class AlignedGrid {
 public:
  static bool suits(const icd::OccupancyGrid& grid, const icd::Placement& placement);
  /// Requires suits().
  AlignedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet);

  /// Draws a part of a row. Call it in the order of the data.
  void draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells);
  std::size_t left_out() const { return left_out_ + without_tile_; }

 private:
  struct Cells {
    std::uint32_t begin = 0, end = 0;
  };
  /// The cells that each pixel shows, along x or along y. Two pixels show the same cells or have no cell in
  /// common.
  struct Axis {
    /// The pixels of the frame along this axis.
    struct Pixels {
      double metres = 0;  // each
      int from = 0, side = 0;
      /// The pixel at `place`, limited to the frame's first pixel and the one after its last.
      int at(double place) const;
    };
    Axis(double origin, double metres_per_cell, std::uint32_t count, const Pixels& pixels);
    std::size_t begin() const { return cells.empty() ? 0 : cells.front().begin; }
    std::size_t end() const { return cells.empty() ? 0 : cells.back().end; }
    int first_pixel = 0;
    std::vector<Cells> cells;  // of first_pixel and those after it; never an empty range
  };
  void row_ended(std::size_t row);
  void make_line();

  Sheet& sheet_;
  Axis columns_, rows_;
  std::size_t width_;
  std::vector<std::uint8_t> highest_;  // per shown column: highest index in the rows of a pixel
  std::vector<std::uint8_t> line_;     // the same for each pixel
  std::size_t next_ = 0;               // index of the first of rows_.cells not yet drawn
  std::size_t left_out_ = 0;
  std::size_t without_tile_ = 0;  // pixels
};

}  // namespace adit::picture
