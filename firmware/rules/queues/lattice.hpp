#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::queues {

/// A rectangle along the axes of the frame that grids are posted in ("darpa"), in metres.
struct Extent {
  double left = 0, bottom = 0, right = 0, top = 0;

  static constexpr Extent infinite() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {-kFar, -kFar, kFar, kFar};
  }
  bool holds(const Extent& other) const {
    return left <= other.left && bottom <= other.bottom && other.right <= right && other.top <= top;
  }
  friend bool operator==(const Extent&, const Extent&) = default;
};

inline Extent bounding_box(const Extent& a, const Extent& b) {
  return {std::min(a.left, b.left), std::min(a.bottom, b.bottom), std::max(a.right, b.right),
          std::max(a.top, b.top)};
}

/// A rectangle that holds all cells of `grid` and at least one more cell on each side. It is larger if the
/// grid is rotated, and infinite() if it has no finite bounds.
Extent extent_of(const icd::OccupancyGrid& grid);

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

inline Cells bounding_box(const Cells& a, const Cells& b) {
  const std::int64_t x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.right(), b.right()) - x, std::max(a.top(), b.top()) - y};
}

inline Cells common(const Cells& a, const Cells& b) {
  const std::int64_t x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::min(a.right(), b.right()) - x, std::min(a.top(), b.top()) - y};
}

/// The cells of `grid`, counted from the lower left cell of `of`; nothing if their lattices differ. One
/// lattice: equal resolution, orientation and height, and origins a whole number of cells apart (to 1/1000).
std::optional<Cells> cells_in(const icd::OccupancyGrid& of, const icd::OccupancyGrid& grid);

/// The pose of the lower left corner of cell (x, y) of `of`'s lattice. Nothing: too far for cells_in().
std::optional<icd::Pose> corner_at(const icd::OccupancyGrid& of, std::int64_t x, std::int64_t y);

/// A square of a canvas with the values that were last packed for it.
struct CanvasTile {
  static constexpr std::int64_t kSide = 64;         // cells
  static constexpr std::uint8_t kNotKnown = 254;    // the last sent value is unknown; no cell has this value
  std::array<std::uint8_t, kSide * kSide> cells{};  // row by row from the lower left cell
  bool is_known = false;                            // all cells are known
};

/// A canvas's cells in a rectangle. Shares the tiles, which never change, so that a worker can read them.
struct Ground {
  std::uint64_t canvas = 0;     // number of the canvas
  Cells cells;                  // the rectangle, on the canvas's lattice
  std::optional<Cells> before;  // a cell without a tile is unknown within it, and was never sent outside
  std::vector<std::shared_ptr<const CanvasTile>> tiles;  // the touched tiles, row by row; null: no tile
};

/// The tiles that `cells` touches, in units of tiles.
Cells tiles_of(const Cells& cells);
inline Cells cells_of_tile(std::int64_t x, std::int64_t y) {
  return {x * CanvasTile::kSide, y * CanvasTile::kSide, CanvasTile::kSide, CanvasTile::kSide};
}

/// The cells of `ground`, row by row. Never sent or unknown cells are ROS's unknown.
std::vector<std::uint8_t> cells_under(const Ground& ground);

/// Draws a map's cells over a Ground.
class Drawing {
 public:
  explicit Drawing(Ground under);
  /// Draws the next cells of the map, row by row. Requires that they fit into the rectangle.
  void feed(std::span<const std::uint8_t> cells);
  /// The ground with new tiles. Requires that all cells of the map were fed.
  Ground finish();

 private:
  void feed_row(std::span<const std::uint8_t> cells);

  Ground ground_;
  Cells tiles_;
  std::vector<std::shared_ptr<CanvasTile>> drawn_;
  std::int64_t fed_ = 0;
};

}  // namespace adit::queues
