#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "queues/lattice.hpp"

namespace adit::queues {

/// A square of a canvas with the values that were last packed for it.
struct CanvasTile {
  static constexpr std::int64_t kSide = 64;         // cells
  static constexpr std::uint8_t kNotKnown = 254;    // the last sent value is unknown; no cell has this value
  std::array<std::uint8_t, kSide * kSide> cells{};  // row by row from the lower left cell
  bool is_known = false;                            // all cells are known
};

/// The cells of a canvas in a rectangle. Shares the tiles, which are immutable, so that a worker can read
/// them.
struct Ground {
  std::uint64_t canvas = 0;     // number of the canvas
  Cells cells;                  // the rectangle, on the canvas's lattice
  std::optional<Cells> before;  // a cell without a tile is unknown within it, and was never sent outside
  std::vector<std::shared_ptr<const CanvasTile>> tiles;  // the touched tiles, row by row; null: no tile
};

/// The tiles that `cells` touches, in units of tiles.
Cells tiles_of(const Cells& cells);
/// The cells of the tile (x, y).
inline Cells cells_of_tile(std::int64_t x, std::int64_t y) {
  return {x * CanvasTile::kSide, y * CanvasTile::kSide, CanvasTile::kSide, CanvasTile::kSide};
}

/// The cells of `ground`, row by row. Cells that were never sent, or whose sent value is unknown, are ROS's
/// unknown.
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
