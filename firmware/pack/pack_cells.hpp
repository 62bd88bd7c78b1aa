#pragma once

#include "icd/map_update.hpp"
#include "pack/effort.hpp"

namespace adit::pack {

/// A grid's cells in the smallest of these forms: as they are kept, by libdeflate at the level of `effort`,
/// or not compressed. Data that is damaged or not compressed stays as it is, and so does all with
/// Effort::None. Otherwise the cells are whole in memory meanwhile, and 1 MiB of libdeflate's.
icd::MapData pack_cells(icd::MapData data, Effort effort);

}  // namespace adit::pack
