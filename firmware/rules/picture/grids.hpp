#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/geometry.hpp"
#include "icd/mapping.hpp"
#include "picture/draw.hpp"

namespace adit::picture {

/// The colour index of a cell; 0 if it is unknown.
inline std::uint8_t index_of_cell(std::uint8_t value) {
  return value <= icd::kMostOccupied ? static_cast<std::uint8_t>(value + 1) : std::uint8_t{0};
}

inline std::size_t known_cells(std::span<const std::uint8_t> cells) {
  return static_cast<std::size_t>(
      std::ranges::count_if(cells, [](std::uint8_t value) { return value <= icd::kMostOccupied; }));
}

/// Cuts a grid's data into rows, piece by piece. Calls `visit(row, column, cells)` with a part of one row.
class RowCutter {
 public:
  RowCutter(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}

  template <class Visit>
  void feed(std::span<const std::uint8_t> piece, Visit visit) {
    while (!piece.empty() && row_ < height_) {
      const auto cells = piece.first(std::min(piece.size(), width_ - column_));
      visit(row_, column_, cells);
      piece = piece.subspan(cells.size());
      column_ += cells.size();
      if (column_ < width_) continue;
      column_ = 0;
      ++row_;
    }
  }

 private:
  std::size_t width_, height_, row_ = 0, column_ = 0;
};

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
