#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "icd/map_update.hpp"

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

}  // namespace adit::picture
