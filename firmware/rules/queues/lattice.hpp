#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "icd/map_update.hpp"

namespace adit::queues {

/// A rectangle of cells of one lattice.
struct Cells {
  std::int64_t x = 0, y = 0;           // the lower left cell
  std::int64_t width = 0, height = 0;  // at least 1

  std::int64_t right() const { return x + width; }  // the first beyond it
  std::int64_t top() const { return y + height; }
  bool holds(const Cells& other) const {
    return x <= other.x && y <= other.y && other.right() <= right() && other.top() <= top();
  }
  bool overlaps(const Cells& other) const {
    return x < other.right() && other.x < right() && y < other.top() && other.y < top();
  }
  friend bool operator==(const Cells&, const Cells&) = default;
};

/// The smallest rectangle that holds both.
inline Cells around(const Cells& a, const Cells& b) {
  const std::int64_t x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.right(), b.right()) - x, std::max(a.top(), b.top()) - y};
}

/// The intersection of two rectangles that overlap.
inline Cells common(const Cells& a, const Cells& b) {
  const std::int64_t x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::min(a.right(), b.right()) - x, std::min(a.top(), b.top()) - y};
}

/// The cells of `grid`, counted from the lower left cell of `of`, or nothing if they have different lattices.
/// One lattice: the same resolution, orientation and height, and origins that are a whole number of cells
/// apart, to a thousandth of a cell.
std::optional<Cells> cells_in(const icd::OccupancyGrid& of, const icd::OccupancyGrid& grid);

/// The pose of the lower left corner of the cell (x, y), counted from the lower left cell of `of`. Nothing if
/// it is too far for cells_in() to count.
std::optional<icd::Pose> corner_at(const icd::OccupancyGrid& of, std::int64_t x, std::int64_t y);

}  // namespace adit::queues
