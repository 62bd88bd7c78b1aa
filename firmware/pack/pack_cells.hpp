#pragma once

#include <optional>

#include "icd/map_update.hpp"
#include "pack/effort.hpp"

namespace adit::pack {

/// A grid's cells in the smallest of these forms: as they are kept, by libdeflate at the level of `effort`,
/// or not compressed; nullopt if that finds the data damaged. Data that is not compressed stays as it is, and
/// so does all with Effort::None. Otherwise the cells are whole in memory meanwhile, and 1 MiB of
/// libdeflate's.
std::optional<icd::MapData> pack_cells(icd::MapData data, Effort effort);

}  // namespace adit::pack
