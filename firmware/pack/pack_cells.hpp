#pragma once

#include <cstddef>

#include "icd/map_update.hpp"

namespace adit::pack {

/// A grid's data in the smallest form that is found in the time that a slot of the link leaves: as it is
/// kept, by GridGzipper, by libdeflate, or not compressed. `data` may be compressed; if that is damaged, it
/// stays as it is.
///
/// Up to 16 MiB of cells are whole in memory meanwhile, larger grids are read piece by piece. Where a grid
/// has no rows to speak of, or does not become small by them, a part of it shows whether libdeflate is
/// better; if so, up to 40 MiB are.
icd::MapData pack_cells(const icd::OccupancyGrid& grid, icd::MapData data);

/// libdeflate's level for so many cells: the smallest one within about 1 s on one core of a small board, and
/// within 1 MiB of its own; those from 10 on ask for 9 MiB at once.
int level_for(std::size_t cells);

}  // namespace adit::pack
