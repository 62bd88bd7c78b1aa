#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "lanes/lattice.hpp"

namespace adit::lanes {

/// So many grids are looked at to find those that become one.
inline constexpr std::size_t kMostStitched = 64;
/// A stitched grid has at most so many cells, and so many bytes in memory while it is packed.
inline constexpr std::int64_t kMostStitchedCells = 4 << 20;

/// With gaps it has at most so many cells for each cell of its grids, those that overlap counted each time.
inline constexpr std::int64_t kMostFilled = 4;

/// Grids that become one: which, in their order, and the rectangle that they fill.
struct Stitch {
  std::vector<std::size_t> which;
  Cells cells;
  bool has_gaps = false;  // but for gaps
};

/// Whether it is known what was last sent of those cells of `all` that none of `grids` has.
using Known = std::function<bool(const Cells& all, std::span<const Cells> grids)>;

/// Of `grids`, in the order they were made and counted on one lattice, the first and those that together with
/// it fill a larger rectangle. It has gaps only where `known` says that what was sent there is: without that,
/// what a server has there is not known. What stays behind overlaps nothing newer that goes, so that it can
/// follow: no old cell is sent after a newer one.
Stitch stitch(std::span<const Cells> grids, const Known& known = {});

/// Whether `tiles`, all within `all`, leave no gap in it.
bool fill(const Cells& all, std::vector<Cells> tiles);

/// `which` as one grid, without its data: the newest's header, and a corner on the lattice of all. Nothing
/// where a double cannot say that corner.
std::optional<icd::OccupancyGrid> stitched(std::span<const icd::OccupancyGrid* const> which);

}  // namespace adit::lanes
