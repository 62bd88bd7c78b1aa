#pragma once

#include <cstddef>

#include "icd/map_update.hpp"
#include "picture/draw.hpp"
#include "picture/sheet.hpp"

namespace adit::picture {

/// Draw a map on an empty sheet. The result is the number of cells, points or pixels that were left out.
icd::Checked<std::size_t> draw_grid(const icd::OccupancyGrid& grid, const icd::MapData& data, Sheet& sheet,
                                    const Between& between);
icd::Checked<std::size_t> draw_cloud(const icd::PointCloud2& cloud, const icd::MapData& data, Sheet& sheet,
                                     const Between& between);

}  // namespace adit::picture
