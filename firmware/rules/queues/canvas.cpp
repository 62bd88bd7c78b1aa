#include "queues/canvas.hpp"

#include <algorithm>
#include <cmath>

#include "icd/require.hpp"
#include "queues/stitch.hpp"

namespace adit::queues {
namespace {

/// No cell of a grid is farther away (cells_in()).
constexpr double kFarthest = 1e15;

std::int64_t cell_at(double metres, double origin, double resolution) {
  return static_cast<std::int64_t>(
      std::clamp(std::floor((metres - origin) / resolution), -kFarthest, kFarthest));
}

/// Cells that hold `extent`; may be more.
Cells cells_about(const icd::OccupancyGrid& lattice, const Extent& extent) {
  const auto& [left, bottom, z] = lattice.origin.position;
  const std::int64_t x = cell_at(extent.left, left, lattice.resolution) - 1;
  const std::int64_t y = cell_at(extent.bottom, bottom, lattice.resolution) - 1;
  return {x, y, cell_at(extent.right, left, lattice.resolution) + 2 - x,
          cell_at(extent.top, bottom, lattice.resolution) + 2 - y};
}

/// The one tile that stands for all tiles with unknown cells.
const std::shared_ptr<const CanvasTile>& not_known() {
  static const auto tile = [] {
    auto made = std::make_shared<CanvasTile>();
    made->cells.fill(CanvasTile::kNotKnown);
    return std::shared_ptr<const CanvasTile>(std::move(made));
  }();
  return tile;
}

bool are_filled(const Cells& part, std::span<const Cells> grids, std::size_t& looks) {
  std::vector<Cells> there;
  for (const Cells& grid : grids) {
    if (grid.overlaps(part)) there.push_back(common(grid, part));
  }
  looks -= std::min(looks, there.size());
  return !there.empty() && fill(part, std::move(there));
}

}  // namespace

Extent extent_of(const icd::OccupancyGrid& grid) {
  const auto& [x, y, z] = grid.origin.position;
  const double width = grid.resolution * (grid.width + 1.0), height = grid.resolution * (grid.height + 1.0);
  const bool is_turned = !Canvas::is_straight(grid);
  const double left = x - (is_turned ? width + height : grid.resolution);
  const double bottom = y - (is_turned ? width + height : grid.resolution);
  const Extent extent{left, bottom, x + width + (is_turned ? height : 0),
                      y + height + (is_turned ? width : 0)};
  const bool is_finite = std::isfinite(extent.left) && std::isfinite(extent.bottom) &&
                         std::isfinite(extent.right) && std::isfinite(extent.top);
  return is_finite ? extent : Extent::everywhere();
}

Canvas::Canvas(std::uint64_t number, const icd::OccupancyGrid& lattice, const std::optional<Extent>& before)
    : number_(number), lattice_(lattice) {
  if (before) before_ = cells_about(lattice_, *before);
}

bool Canvas::is_straight(const icd::OccupancyGrid& grid) {
  const auto& [x, y, z, w] = grid.origin.orientation;
  return x == 0 && y == 0 && z == 0;
}

bool Canvas::can_draw(const icd::OccupancyGrid& grid) {
  const Cells cells{0, 0, grid.width, grid.height};
  if (!is_straight(grid) || cells.width > kMostStitchedCells / cells.height) return false;
  return (cells.width / CanvasTile::kSide + 2) * (cells.height / CanvasTile::kSide + 2) <= kMostTouched;
}

bool Canvas::knows(const Cells& from, Cells all, std::span<const Cells> grids, std::size_t& looks) const {
  std::vector<Cells> here(grids.begin(), grids.end());
  for (Cells& grid : here) grid.x += from.x, grid.y += from.y;
  all.x += from.x, all.y += from.y;
  const Cells touched = tiles_of(all);
  for (std::int64_t y = touched.y; y < touched.top(); ++y) {
    for (std::int64_t x = touched.x; x < touched.right(); ++x) {
      if (looks == 0) return false;
      --looks;
      Cells part = common(cells_of_tile(x, y), all);
      const auto found = tiles_.find({y, x});
      if (found != tiles_.end() && found->second.tile->is_known) continue;
      if (found == tiles_.end() && !has_before(part)) continue;
      if (found == tiles_.end()) part = common(part, *before_);
      if (!are_filled(part, here, looks)) return false;
    }
  }
  return true;
}

Ground Canvas::under(const Cells& cells) const {
  Ground ground{.canvas = number_, .cells = cells, .before = before_, .tiles = {}};
  const Cells touched = tiles_of(cells);
  for (std::int64_t y = touched.y; y < touched.top(); ++y) {
    for (std::int64_t x = touched.x; x < touched.right(); ++x) {
      const auto found = tiles_.find({y, x});
      ground.tiles.push_back(found == tiles_.end() ? nullptr : found->second.tile);
    }
  }
  return ground;
}

void Canvas::forget(const Cells& cells) {
  const Cells touched = tiles_of(cells);
  icd::require(touched.width * touched.height <= kMostTouched);
  for (std::int64_t y = touched.y; y < touched.top(); ++y) {
    for (std::int64_t x = touched.x; x < touched.right(); ++x) tiles_[{y, x}] = {not_known(), 0};
  }
}

void Canvas::lay(const Ground& drawn, std::uint64_t when) noexcept {
  const Cells touched = tiles_of(drawn.cells);
  std::size_t i = 0;
  for (std::int64_t y = touched.y; y < touched.top(); ++y) {
    for (std::int64_t x = touched.x; x < touched.right(); ++x, ++i) {
      const auto found = tiles_.find({y, x});
      if (found != tiles_.end()) found->second = {drawn.tiles[i], when};
    }
  }
}

void Canvas::add_times(std::vector<std::uint64_t>& when) const {
  for (const auto& [place, laid] : tiles_) {
    if (laid.when > 0) when.push_back(laid.when);
  }
}

void Canvas::forget_before(std::uint64_t when) noexcept {
  for (auto& [place, laid] : tiles_) {
    if (laid.when > 0 && laid.when < when) laid = {not_known(), 0};
  }
}

}  // namespace adit::queues
