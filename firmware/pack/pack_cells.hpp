#pragma once

#include <optional>

#include "icd/map_update.hpp"
#include "pack/effort.hpp"

namespace adit::pack {

/// The smallest form of a grid's cells: as stored, compressed by libdeflate at the level of `effort`, or
/// uncompressed. nullopt if the data is damaged. Uncompressed data, and any data with Effort::None, is
/// returned unchanged. Otherwise all cells are in memory meanwhile, with 1 MiB for libdeflate.
std::optional<icd::MapData> pack_cells(icd::MapData data, Effort effort);

}  // namespace adit::pack
