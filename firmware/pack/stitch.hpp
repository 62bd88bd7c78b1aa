#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/status.hpp"

namespace adit::pack {

/// A grid's cells, and where they lie in a larger one: columns and rows from its lower left cell.
struct Tile {
  icd::MapData data;
  std::size_t column = 0, row = 0;
  std::size_t width = 0, height = 0;  // cells; data.raw_size is their product
};

/// The cells of a grid of width x height, made of `tiles`, which lie within it: a later one over an earlier
/// one, unknown cells too. What none of them fills is as in `under`, which has as many cells; without it,
/// unknown. The error says what is wrong with the data of one. CPU-bound in the cells, and meant for a
/// worker.
icd::Checked<icd::MapData> stitch(std::size_t width, std::size_t height, std::span<const Tile> tiles,
                                  std::vector<std::uint8_t> under = {});

}  // namespace adit::pack
