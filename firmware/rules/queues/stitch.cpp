#include "queues/stitch.hpp"

#include <algorithm>
#include <utility>

namespace adit::queues {
namespace {

/// Bounds the work. A try costs at most the square of the number of grids.
constexpr std::size_t kMostTries = 64;

/// Whether `tiles`, which lie within `all` and are sorted by x, fill the row of cells at `y` without a gap.
bool fill_row(const Cells& all, const std::vector<Cells>& tiles, std::int64_t y) {
  std::int64_t filled = all.x;
  for (const Cells& tile : tiles) {
    if (tile.y > y || tile.top() <= y) continue;
    if (tile.x > filled) return false;
    filled = std::max(filled, tile.right());
  }
  return filled == all.right();
}

/// Whether the grids within `all` have enough cells to fill it; with gaps, enough for kMostFilled.
bool can_fill(const Cells& all, std::span<const Cells> grids, bool with_gaps) {
  if (all.width > kMostStitchedCells / all.height) return false;
  std::int64_t most = 0;
  for (const Cells& grid : grids) {
    const bool is_in = all.holds(grid) && grid.width <= kMostStitchedCells / grid.height;
    most += is_in ? grid.width * grid.height : 0;
  }
  return most * (with_gaps ? kMostFilled : 1) >= all.width * all.height;
}

/// The grids within `all` that overlap no older grid that is left out.
std::vector<std::size_t> removable_grids(const Cells& all, std::span<const Cells> grids) {
  std::vector<std::size_t> which;
  std::vector<Cells> behind;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const auto is_over = [&](const Cells& older) { return grids[i].overlaps(older); };
    if (all.holds(grids[i]) && std::ranges::none_of(behind, is_over)) {
      which.push_back(i);
    } else {
      behind.push_back(grids[i]);
    }
  }
  return which;
}

std::vector<Cells> select_cells(std::span<const Cells> grids, const std::vector<std::size_t>& which) {
  std::vector<Cells> cells;
  cells.reserve(which.size());
  for (const std::size_t i : which) cells.push_back(grids[i]);
  return cells;
}

/// The grids that fill `all`; nothing if they cannot.
std::optional<Stitch> filling(const Cells& all, std::span<const Cells> grids, const Known& known) {
  auto which = removable_grids(all, grids);
  const auto those = select_cells(grids, which);
  const bool has_gaps = !fill(all, those);
  if (has_gaps && !(known && known(all, those))) return {};
  return Stitch{std::move(which), all, has_gaps};
}

}  // namespace

/// All rows between two successive edges have the same tiles.
bool fill(const Cells& all, std::vector<Cells> tiles) {
  std::ranges::sort(tiles, {}, &Cells::x);
  if (!fill_row(all, tiles, all.y)) return false;
  return std::ranges::all_of(tiles, [&](const Cells& tile) {
    return (tile.y == all.y || fill_row(all, tiles, tile.y)) &&
           (tile.top() == all.top() || fill_row(all, tiles, tile.top()));
  });
}

/// Grows the rectangle by one grid at a time, and includes all grids that are within it then.
Stitch stitch(std::span<const Cells> grids, const Known& known) {
  grids = grids.first(std::min(grids.size(), kMostStitched));
  Stitch best{{0}, grids.front()};
  if (!can_fill(best.cells, grids, false)) return best;
  if (auto with_those_within = filling(best.cells, grids, {})) best = std::move(*with_those_within);
  std::size_t tries = 0;
  for (std::size_t i = 0, in_vain = 0; in_vain < grids.size() && tries < kMostTries; ++i, ++in_vain) {
    const Cells all = bounding_box(best.cells, grids[i % grids.size()]);
    if (all == best.cells || !can_fill(all, grids, known != nullptr)) continue;
    ++tries;
    if (auto larger = filling(all, grids, known)) {
      best = std::move(*larger);
      in_vain = 0;
    }
  }
  return best;
}

std::optional<icd::OccupancyGrid> stitch_grids(std::span<const icd::OccupancyGrid* const> which) {
  const icd::OccupancyGrid& first = *which.front();
  std::optional<Cells> all;
  for (const auto* grid : which) {
    const auto cells = cells_in(first, *grid);
    if (!cells) return {};
    all = all ? bounding_box(*all, *cells) : *cells;
  }
  const auto corner = corner_at(first, all->x, all->y);
  if (!corner) return {};
  icd::OccupancyGrid whole = *which.back();
  whole.width = static_cast<std::uint32_t>(all->width);
  whole.height = static_cast<std::uint32_t>(all->height);
  whole.origin = *corner;
  for (const auto* grid : which) {
    const auto cells = cells_in(first, *grid);
    if (cells->x == all->x && cells->y == all->y) whole.origin = grid->origin;  // as it was given
  }
  const auto is_within = [&](const icd::OccupancyGrid* grid) {
    const auto cells = cells_in(whole, *grid);
    return cells && Cells{0, 0, whole.width, whole.height}.holds(*cells);
  };
  if (!std::ranges::all_of(which, is_within)) return {};
  return whole;
}

}  // namespace adit::queues
