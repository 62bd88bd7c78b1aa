#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "icd/mapping.hpp"
#include "queues/lattice.hpp"

namespace adit::queues {

/// The most grids that stitch() looks at.
inline constexpr std::size_t kMostStitched = 64;
/// The most cells of a stitched grid. Each takes a byte of memory while the grid is packed.
inline constexpr std::int64_t kMostStitchedCells = 4 << 20;

/// A grid with gaps has at most so many times its grids' cells; a cell of two grids counts twice.
inline constexpr std::int64_t kMostFilled = 4;

/// Grids that become one grid: their indices, in order, and the rectangle that they fill.
struct Stitch {
  std::vector<std::size_t> which;
  Cells cells;
  bool has_gaps = false;  // they do not fill it completely
};

/// Whether the last sent value is known for each cell of `all` that is in none of `grids`.
using Known = std::function<bool(const Cells& all, std::span<const Cells> grids)>;

/// Finds the grids that fill a larger rectangle together with the first one. `grids`: on one lattice, in the
/// order in which they were made. A gap is allowed only if `known` is true of it, or the server's cells there
/// would be unknown. Grids left out overlap no newer grid that goes, so that no old cell follows a newer one.
Stitch stitch(std::span<const Cells> grids, const Known& known = {});

/// Whether `tiles`, which lie within `all`, fill it without a gap.
bool fill(const Cells& all, std::vector<Cells> tiles);

/// The stitched grid without its data: it has the header of the newest one, and its origin on their lattice.
/// Nothing if the origin cannot be expressed in doubles.
std::optional<icd::OccupancyGrid> stitch_grids(std::span<const icd::OccupancyGrid* const> which);

}  // namespace adit::queues
