#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/status.hpp"
#include "picture/canvas.hpp"

namespace adit::picture {

/// Heights above z = 0 of "darpa", in metres.
struct Heights {
  double low = 0, high = 0;
  friend bool operator==(const Heights&, const Heights&) = default;
};

/// What a map changes in the picture of its layer.
struct Drawing {
  Layer layer;
  std::uint64_t run = 0;                       // the canvas's
  std::vector<std::pair<TileAt, Tile>> tiles;  // of all levels, and only those that changed; none is null
  std::optional<Area> area;                    // of all that the map says, to a pixel of the base
  std::optional<Heights> heights;  // of a cloud: all but the lowest and highest hundredth of its pixels
  std::size_t left_out = 0;        // cells, points or pixels outside the world, or over a limit below
};

/// Called again and again while a map is drawn: after each piece of its data, some 64 KB.
using Between = std::function<void()>;

/// Draws `map` upon `before`, the canvas of layer_of(map). CPU-bound in the size of the map: for a worker.
///
/// Of all that falls on a pixel the highest counts: the most occupied cell (occupied, free, unknown), the
/// highest point. Where something was drawn before, what a grid knows replaces it and what it does not know
/// leaves it; a cloud only rises. A pixel of a coarser level is the highest of the sixteen it stands for.
///
/// Data under gzip is inflated piece by piece; the error says what is wrong with it.
icd::Checked<Drawing> draw(const icd::MapUpdate& map, const Canvas& before, const Between& between = [] {});

/// Limits of one drawing, whatever the map says, beside Sheet::kMostTiles.
/// Points that are looked at: of more, each second or third and so on is.
inline constexpr std::size_t kMostPoints = std::size_t{4} << 20;
/// Cells in a row.
inline constexpr std::size_t kMostColumns = std::size_t{1} << 20;
/// Pixels that a turned grid sets, or that another one has no tile for; and the longest side of a turned
/// grid's cells, in pixels.
inline constexpr std::size_t kMostDabs = std::size_t{32} << 20;
inline constexpr double kLargestTurnedCell = 64;

}  // namespace adit::picture
