#pragma once

#include <array>
#include <memory>
#include <span>

#include "picture/draw.hpp"
#include "picture/forwarded_grids.hpp"
#include "picture/tile.hpp"

namespace adit::picture {

/// The tiles that make up one tile of the next coarser level: row by row from the lower left. Null if no grid
/// lies there, so that only the coarser tile is known.
using FineBlock = std::array<Tile, std::size_t{kFineStep} * kFineStep>;

/// A tile's index in the block of its coarser tile.
inline std::size_t place_in_block(const TileIndex& at) {
  const TileIndex over = coarser(at);
  return static_cast<std::size_t>((at.y - over.y * kFineStep) * kFineStep + at.x - over.x * kFineStep);
}

/// Draws `grids` over each other, in their order, at the level below `over.level`. `under` is the tile at
/// `over` (null: blank). Its pixel is shown if nothing finer is known there. So the picture never shows less
/// than the coarse one, even after grids have been dropped.
/// The time grows with the grids, so call it on a worker. A damaged grid is drawn as far as it can be read.
FineBlock draw_fine(
    const TileIndex& over, std::span<const std::shared_ptr<const ForwardedGrid>> grids, const Tile& under,
    const Between& between = [] {});

/// Draws the block that contains `at`, level by level from the base.
FineBlock draw_fine_from_base(
    const TileIndex& at, std::span<const std::shared_ptr<const ForwardedGrid>> grids, const Tile& base,
    const Between& between = [] {});

}  // namespace adit::picture
