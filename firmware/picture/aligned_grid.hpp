#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/placement.hpp"
#include "picture/sheet.hpp"

namespace adit::picture {

/// Draws a grid whose rows run along x, as nearly all do. A pixel shows the cells whose centres lie in it,
/// or, where cells are larger than pixels, the cell that its own centre lies in.
class AlignedGrid {
 public:
  static bool suits(const icd::OccupancyGrid& grid, const icd::Placement& placement);
  /// Requires suits().
  AlignedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet);

  /// A part of a row, in the order of the data.
  void draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells);
  std::size_t left_out() const { return left_out_ + without_tile_; }

 private:
  struct Cells {
    std::uint32_t begin = 0, end = 0;
  };
  /// Which cells each pixel shows, along x or along y. The cells of two pixels are the same ones or have none
  /// in common.
  struct Axis {
    /// Those of the frame along it.
    struct Pixels {
      double metres = 0;  // each
      int from = 0, side = 0;
      /// The pixel there, or the frame's first one, or the one after its last.
      int at(double place) const;
    };
    Axis(double origin, double metres_per_cell, std::uint32_t count, const Pixels& pixels);
    std::size_t begin() const { return cells.empty() ? 0 : cells.front().begin; }
    std::size_t end() const { return cells.empty() ? 0 : cells.back().end; }
    int first_pixel = 0;
    std::vector<Cells> cells;  // of first_pixel and those after it; none has none
  };
  void row_ended(std::size_t row);
  void make_line();

  Sheet& sheet_;
  Axis columns_, rows_;
  std::size_t width_;
  std::vector<std::uint8_t> highest_;  // for each column that is shown, of the rows of one pixel
  std::vector<std::uint8_t> line_;     // the same for each pixel
  std::size_t next_ = 0;               // the first of rows_.cells that is not yet drawn
  std::size_t left_out_ = 0;
  std::size_t without_tile_ = 0;  // pixels
};

}  // namespace adit::picture
