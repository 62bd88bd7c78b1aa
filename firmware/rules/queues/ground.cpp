#include "queues/ground.hpp"

#include <algorithm>

#include "icd/require.hpp"

namespace adit::queues {
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
