#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/mapping.hpp"
#include "icd/status.hpp"

namespace adit::pack {

/// A grid's cells and their place in a larger grid: column and row of its lower left cell.
struct Tile {
  icd::MapData data;
  std::size_t column = 0, row = 0;
  std::size_t width = 0, height = 0;  // cells; data.raw_size is their product
};

/// Puts `tiles`, which lie within it, into a grid of width x height. A later tile overwrites an earlier one,
/// even with unknown cells. Other cells come from `under`, of as many cells; if it is empty, they are
/// unknown. Errors are about a tile's data. The time grows with the cells, so call it on a worker.
icd::Checked<icd::MapData> stitch(std::size_t width, std::size_t height, std::span<const Tile> tiles,
                                  std::vector<std::uint8_t> under = {});

/// Sets the data of `tiles`, which lie within a grid of `width` cells with these `cells`, and gzips it. An
/// error names the fault of the cells. For a worker, too.
icd::Checked<void> cut(const icd::MapData& cells, std::size_t width, std::span<Tile> tiles);

}  // namespace adit::pack
