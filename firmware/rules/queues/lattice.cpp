#include "queues/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "icd/geometry.hpp"
#include "icd/require.hpp"

namespace adit::queues {
namespace {

/// Origins are compared in thousandths of a cell, because a multiple of the resolution (a float32 in ROS) has
/// rounding errors. Both are rounded to these steps; with a tolerance, a chain of lattices could drift.
constexpr std::int64_t kStepsPerCell = 1000;
/// Larger doubles cannot express thousandths.
constexpr double kMostSteps = 9007199254740992.0;

/// The position of a grid's lower left corner, in steps along the grid's own axes.
struct Corner {
  std::int64_t x = 0, y = 0, z = 0;
};

/// An origin's position along its own axes: the product of the transposed rotation matrix and the position.
icd::Point turned_back(const icd::Pose& origin) {
  const auto& [turn, p] = icd::Placement{origin};
  return {turn[0][0] * p.x + turn[1][0] * p.y + turn[2][0] * p.z,
          turn[0][1] * p.x + turn[1][1] * p.y + turn[2][1] * p.z,
          turn[0][2] * p.x + turn[1][2] * p.y + turn[2][2] * p.z};
}

/// Nothing if the grid is so far away that doubles cannot distinguish its cells.
std::optional<Corner> corner_of(const icd::OccupancyGrid& grid) {
  const icd::Point p = turned_back(grid.origin);
  const double scale = static_cast<double>(kStepsPerCell) / grid.resolution;
  const double x = p.x * scale, y = p.y * scale, z = p.z * scale;
  const auto tellable = [](double steps) { return std::abs(steps) < kMostSteps; };  // false for NaN
  if (!tellable(x) || !tellable(y) || !tellable(z)) return {};
  return Corner{std::llround(x), std::llround(y), std::llround(z)};
}

/// Steps as cells; nothing if they are not a whole number of cells.
std::optional<std::int64_t> to_cells(std::int64_t steps) {
  if (steps % kStepsPerCell != 0) return {};
  return steps / kStepsPerCell;
}

Cells cells_at(std::int64_t x, std::int64_t y, const icd::OccupancyGrid& grid) {
  return {x, y, grid.width, grid.height};
}

}  // namespace

std::optional<Cells> cells_in(const icd::OccupancyGrid& of, const icd::OccupancyGrid& grid) {
  if (grid.resolution != of.resolution || grid.origin.orientation != of.origin.orientation) {
    return {};
  }
  const auto from = corner_of(of), to = corner_of(grid);
  if (!from || !to) return of.origin == grid.origin ? std::optional(cells_at(0, 0, grid)) : std::nullopt;
  const auto x = to_cells(to->x - from->x), y = to_cells(to->y - from->y);
  if (!x || !y || to->z != from->z) return {};
  return cells_at(*x, *y, grid);
}

/// In the middle of its step, so that rounding errors do not change the step.
std::optional<icd::Pose> corner_at(const icd::OccupancyGrid& of, std::int64_t x, std::int64_t y) {
  const auto from = corner_of(of);
  if (!from) return {};
  const double step = of.resolution / static_cast<double>(kStepsPerCell);
  const icd::Point there{static_cast<double>(from->x + x * kStepsPerCell) * step,
                         static_cast<double>(from->y + y * kStepsPerCell) * step, turned_back(of.origin).z};
  const icd::Placement turned{{.position = {}, .orientation = of.origin.orientation}};
  return icd::Pose{turned(there), of.origin.orientation};
}

namespace {

constexpr std::int64_t kSide = CanvasTile::kSide;

std::int64_t tile_at(std::int64_t cell) {
  return cell >= 0 ? cell / kSide : -((-cell - 1) / kSide) - 1;
}

std::size_t place_in(const Cells& all, std::int64_t x, std::int64_t y) {
  return static_cast<std::size_t>((y - all.y) * all.width + (x - all.x));
}

/// A new tile: no cell was sent, or the sent cells are unknown.
CanvasTile empty_tile(const Cells& its, const std::optional<Cells>& before) {
  CanvasTile tile;
  tile.cells.fill(icd::kUnknownCell);
  if (!before || !before->overlaps(its)) return tile;
  const Cells part = common(its, *before);
  for (std::int64_t y = part.y; y < part.top(); ++y) {
    const auto row = tile.cells.begin() + static_cast<std::ptrdiff_t>(place_in(its, part.x, y));
    std::fill(row, row + part.width, CanvasTile::kNotKnown);
  }
  return tile;
}

}  // namespace

Cells tiles_of(const Cells& cells) {
  const std::int64_t x = tile_at(cells.x), y = tile_at(cells.y);
  return {x, y, tile_at(cells.right() - 1) - x + 1, tile_at(cells.top() - 1) - y + 1};
}

std::vector<std::uint8_t> cells_under(const Ground& ground) {
  const Cells& all = ground.cells;
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(all.width * all.height), icd::kUnknownCell);
  const Cells tiles = tiles_of(all);
  for (std::size_t i = 0; i < ground.tiles.size(); ++i) {
    if (!ground.tiles[i]) continue;
    const auto place = static_cast<std::int64_t>(i);
    const Cells its = cells_of_tile(tiles.x + place % tiles.width, tiles.y + place / tiles.width);
    const Cells part = common(its, all);
    for (std::int64_t y = part.y; y < part.top(); ++y) {
      const auto from = std::span(ground.tiles[i]->cells)
                            .subspan(place_in(its, part.x, y), static_cast<std::size_t>(part.width));
      std::ranges::replace_copy(from, cells.begin() + static_cast<std::ptrdiff_t>(place_in(all, part.x, y)),
                                CanvasTile::kNotKnown, icd::kUnknownCell);
    }
  }
  return cells;
}

Drawing::Drawing(Ground under) : ground_(std::move(under)), tiles_(tiles_of(ground_.cells)) {
  icd::require(ground_.tiles.size() == static_cast<std::size_t>(tiles_.width * tiles_.height));
  drawn_.reserve(ground_.tiles.size());
  for (std::int64_t y = tiles_.y; y < tiles_.top(); ++y) {
    for (std::int64_t x = tiles_.x; x < tiles_.right(); ++x) {
      const auto& old = ground_.tiles[drawn_.size()];
      drawn_.push_back(
          std::make_shared<CanvasTile>(old ? *old : empty_tile(cells_of_tile(x, y), ground_.before)));
    }
  }
}

void Drawing::feed(std::span<const std::uint8_t> cells) {
  const std::int64_t width = ground_.cells.width;
  while (!cells.empty()) {
    const auto left = static_cast<std::size_t>(width - fed_ % width);
    const auto row = cells.first(std::min(cells.size(), left));
    feed_row(row);
    cells = cells.subspan(row.size());
  }
}

void Drawing::feed_row(std::span<const std::uint8_t> cells) {
  const Cells& all = ground_.cells;
  const std::int64_t y = all.y + fed_ / all.width;
  icd::require(y < all.top());
  while (!cells.empty()) {
    const std::int64_t x = all.x + fed_ % all.width, tile_x = tile_at(x), tile_y = tile_at(y);
    const Cells its = cells_of_tile(tile_x, tile_y);
    const auto run = cells.first(std::min(cells.size(), static_cast<std::size_t>(its.right() - x)));
    CanvasTile& tile = *drawn_[place_in(tiles_, tile_x, tile_y)];
    std::ranges::copy(run, tile.cells.begin() + static_cast<std::ptrdiff_t>(place_in(its, x, y)));
    fed_ += static_cast<std::int64_t>(run.size());
    cells = cells.subspan(run.size());
  }
}

Ground Drawing::finish() {
  icd::require(fed_ == ground_.cells.width * ground_.cells.height);
  for (std::size_t i = 0; i < drawn_.size(); ++i) {
    drawn_[i]->is_known =
        std::ranges::find(drawn_[i]->cells, CanvasTile::kNotKnown) == drawn_[i]->cells.end();
    ground_.tiles[i] = std::move(drawn_[i]);
  }
  return std::move(ground_);
}

}  // namespace adit::queues
