#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "queues/lattice.hpp"
#include "queues/map_queue.hpp"

namespace adit::queues {

/// Copies the uncompressed cells of `part` over those of `grid`, which contains it.
inline void lay(std::vector<std::uint8_t>& cells, const icd::OccupancyGrid& grid,
                const icd::MapUpdate& part) {
  const auto place = cells_in(grid, std::get<icd::OccupancyGrid>(part.msg));
  const auto values = part.data.bytes.to_vector();
  for (std::int64_t row = 0; row < place->height; ++row) {
    std::copy_n(values.begin() + row * place->width, place->width,
                cells.begin() + (place->y + row) * grid.width + place->x);
  }
}

/// The cells of a grid from pop(), packed as by the gateway, which informs the queue.
inline std::vector<std::uint8_t> packed_of(MapQueue& queue, const QueuedMap& taken) {
  const auto& grid = std::get<icd::OccupancyGrid>(taken.map.msg);
  std::vector<std::uint8_t> cells(std::size_t{grid.width} * grid.height, icd::kUnknownCell);
  if (taken.has_gaps) cells = cells_under(*taken.ground);
  for (const QueuedMap& part : taken.parts) lay(cells, grid, part.map);
  if (taken.parts.empty()) lay(cells, grid, taken.map);
  if (taken.ground) {
    Drawing drawing(*taken.ground);
    drawing.feed(cells);
    queue.canvases().lay(taken.map.name, drawing.finish());
  }
  return cells;
}

}  // namespace adit::queues
