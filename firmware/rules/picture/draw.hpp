#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/status.hpp"
#include "picture/sheet.hpp"
#include "picture/tile.hpp"

namespace adit::picture {

/// The present tiles of a layer, to draw on. Tiles never change, so a worker may read them.
struct Canvas {
  std::uint64_t run = 0;            // the mosaic's run to which it belongs
  std::map<TileIndex, Tile> tiles;  // never null
};

/// Heights above z = 0 of "darpa", in metres.
struct Heights {
  double low = 0, high = 0;
  friend bool operator==(const Heights&, const Heights&) = default;
};

/// The changes that a map makes to the picture of its layer.
struct Drawing {
  Layer layer;
  std::uint64_t run = 0;                          // the canvas's
  std::vector<std::pair<TileIndex, Tile>> tiles;  // the changed tiles of all levels; never null
  std::optional<Area> area;                       // the known part of the map, to a pixel of the base
  std::optional<Heights> heights;  // of a cloud, without the lowest and highest hundredth of its pixels
  std::size_t left_out = 0;        // cells, points or pixels outside the world or over a limit below
};

/// Called repeatedly while a map is drawn: after each piece of its data, about 64 KB.
using Between = std::function<void()>;

/// Draws `map` on `before`, the canvas of layer_of(map). The time grows with the map, so call it on a worker.
///
/// A pixel shows the highest of all values that fall on it: the most occupied cell (occupied, free, unknown)
/// or the highest point. The known cells of a grid replace earlier ones; its unknown cells leave them. A
/// cloud only raises pixels. A pixel of a coarser level is the highest of its sixteen pixels.
///
/// Gzipped data is inflated piece by piece. An error says what is wrong with it.
icd::Checked<Drawing> draw(const icd::MapUpdate& map, const Canvas& before, const Between& between = [] {});

/// Limits of one drawing, in addition to Sheet::kMostTiles.
/// Points that are drawn. Of a larger cloud, only every second, third and so on is drawn.
inline constexpr std::size_t kMostPoints = std::size_t{4} << 20;
/// Cells in a row.
inline constexpr std::size_t kMostColumns = std::size_t{1} << 20;
/// Pixels that a turned grid sets, or that have no tile in another grid. Then the longest side of a turned
/// grid's cells, in pixels.
inline constexpr std::size_t kMostDabs = std::size_t{32} << 20;
inline constexpr double kLargestTurnedCell = 64;

/// Draw a map on an empty sheet. The result is the number of cells, points or pixels that were left out.
icd::Checked<std::size_t> draw_grid(const icd::OccupancyGrid& grid, const icd::MapData& data, Sheet& sheet,
                                    const Between& between);
icd::Checked<std::size_t> draw_cloud(const icd::PointCloud2& cloud, const icd::MapData& data, Sheet& sheet,
                                     const Between& between);

}  // namespace adit::picture
