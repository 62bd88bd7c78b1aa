#pragma once

#include <array>
#include <memory>
#include <span>

#include "picture/draw.hpp"
#include "picture/forwarded_grids.hpp"
#include "picture/tile.hpp"

namespace adit::picture {

/// The tiles of a finer level that one tile of the next coarser level is made of: row by row from the lower
/// left. Null: no grid lies there, and nothing finer than that tile is known.
using FineBlock = std::array<Tile, std::size_t{kFineStep} * kFineStep>;

/// Which of its coarser tile's block a tile is.
inline std::size_t place_in_block(const TileAt& at) {
  const TileAt over = coarser(at);
  return static_cast<std::size_t>((at.y - over.y * kFineStep) * kFineStep + at.x - over.x * kFineStep);
}

/// Draws `grids` over each other, in their order, as finely as the level below `over.level` has it. `under`
/// is what is drawn at `over` (null: nothing): a pixel of it in which nothing finer is known is shown as it
/// is. So where grids are not kept any more, the picture is as coarse as it was, and nowhere less than it.
///
/// CPU-bound in the size of the grids: for a worker. Of a grid that cannot be read, what could be is drawn.
FineBlock draw_fine(
    const TileAt& over, std::span<const std::shared_ptr<const ForwardedGrid>> grids, const Tile& under,
    const Between& between = [] {});

/// The same for the block that `at` is of, from the base on.
FineBlock draw_fine_from_base(
    const TileAt& at, std::span<const std::shared_ptr<const ForwardedGrid>> grids, const Tile& base,
    const Between& between = [] {});

}  // namespace adit::picture
