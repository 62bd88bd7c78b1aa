#pragma once

#include <cstddef>
#include <cstdint>

#include "icd/map_update.hpp"

namespace adit::pack {

/// How much is done to make a map small.
enum class Effort : std::uint8_t {
  None,   // points as they came, without those that are not finite; cells as they are kept
  Quick,  // points without padding, in their order, at the fastest level of gzip; cells at kQuickCellsLevel
  Full,   // points as CloudForm says; cells at kCellsLevel
};

/// What the effort for a map hangs on.
struct Hurry {
  double bytes_per_second = 0;  // that its link carries, if the map can leave at once; 0: it waits meanwhile
  double slowness = 1;          // of this box: seconds_for() times that
  double longest = 1;           // seconds that it may be under way
};

/// What an effort takes for a byte, and what Full makes of a byte that Quick makes: as measured
/// (tests/bench/README.md, of exact clouds).
inline constexpr double kSecondsPerByte[] = {0, 7e-9, 15e-9};
inline constexpr double kFullOfQuick = 0.85;

/// libdeflate's levels for cells: the next higher one takes 9 MiB of memory, a lower one is hardly faster.
inline constexpr int kCellsLevel = 9, kQuickCellsLevel = 2;

/// The effort with which the last byte of a cloud of `size` bytes is there first, if Quick makes `quick_to`
/// of a byte. Full, unless another one saves a tenth of the time, for what is larger is in the way of others;
/// none that takes longer than `longest` to leave, but Full.
Effort effort_for(std::size_t size, double quick_to, const Hurry& hurry);

/// The same, for an exact cloud that is not compressed: a part of it is tried, if that can matter.
///
/// For a grid as it is kept: the greatest effort that takes at most half of `longest`, half a second, and as
/// long as the grid takes to leave as it is kept. None for more than 40 MiB of cells, because they are whole
/// in memory meanwhile; more than 16 MiB must be worth it: their kept form has more than a byte for 40 cells.
Effort effort_for(const icd::MapUpdate& map, const Hurry& hurry);

/// Seconds for packing `map`, uncompressed points or kept cells, on the box of tests/bench/README.md: the
/// usual ones for a cloud, the most for a grid.
double seconds_for(Effort effort, const icd::MapUpdate& map);

}  // namespace adit::pack
