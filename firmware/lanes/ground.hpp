#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "lanes/lattice.hpp"

namespace adit::lanes {

/// A square of a canvas: the newest values that were packed to be sent there.
struct CanvasTile {
  static constexpr std::int64_t kSide = 64;         // cells
  static constexpr std::uint8_t kNotKnown = 254;    // no value of a cell: what was sent there is not known
  std::array<std::uint8_t, kSide * kSide> cells{};  // row by row from the lower left one
  bool is_known = false;                            // each of them
};

/// What lies under a rectangle of a canvas. Shares the tiles, which do not change, so that a worker can read
/// them.
struct Ground {
  std::uint64_t canvas = 0;     // its number
  Cells cells;                  // the rectangle, on the canvas's lattice
  std::optional<Cells> before;  // within it, a cell without a tile is not known; elsewhere nothing was sent
  std::vector<std::shared_ptr<const CanvasTile>> tiles;  // that it touches, row by row; null: none
};

/// The tiles that `cells` touches, counted in tiles.
Cells tiles_of(const Cells& cells);
/// The cells of the tile in that place.
inline Cells cells_of_tile(std::int64_t x, std::int64_t y) {
  return {x * CanvasTile::kSide, y * CanvasTile::kSide, CanvasTile::kSide, CanvasTile::kSide};
}

/// The cells of `ground`, row by row: unknown where nothing was sent, and where it is not known what was.
std::vector<std::uint8_t> cells_under(const Ground& ground);

/// A map's cells over what lies under it.
class Drawing {
 public:
  explicit Drawing(Ground under);
  /// The next cells of the map, row by row. Requires that the rectangle has room for them.
  void feed(std::span<const std::uint8_t> cells);
  /// With new tiles. Requires all cells of the map.
  Ground finish();

 private:
  void feed_row(std::span<const std::uint8_t> cells);

  Ground ground_;
  Cells tiles_;
  std::vector<std::shared_ptr<CanvasTile>> drawn_;
  std::int64_t fed_ = 0;
};

}  // namespace adit::lanes
