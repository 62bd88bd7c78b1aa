#include "queues/canvases.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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
const std::shared_ptr<const CanvasTile>& unknown_tile() {
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
  const bool is_turned = grid.origin.orientation.is_turned();
  const double left = x - (is_turned ? width + height : grid.resolution);
  const double bottom = y - (is_turned ? width + height : grid.resolution);
  const Extent extent{left, bottom, x + width + (is_turned ? height : 0),
                      y + height + (is_turned ? width : 0)};
  const bool is_finite = std::isfinite(extent.left) && std::isfinite(extent.bottom) &&
                         std::isfinite(extent.right) && std::isfinite(extent.top);
  return is_finite ? extent : Extent::infinite();
}

Canvas::Canvas(std::uint64_t number, const icd::OccupancyGrid& lattice, const std::optional<Extent>& before)
    : number_(number), lattice_(lattice) {
  if (before) before_ = cells_about(lattice_, *before);
}

bool Canvas::can_draw(const icd::OccupancyGrid& grid) {
  const Cells cells{0, 0, grid.width, grid.height};
  if (grid.origin.orientation.is_turned() || cells.width > kMostStitchedCells / cells.height) return false;
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

Ground Canvas::ground_at(const Cells& cells) const {
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
    for (std::int64_t x = touched.x; x < touched.right(); ++x) tiles_[{y, x}] = {unknown_tile(), 0};
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
    if (laid.when > 0 && laid.when < when) laid = {unknown_tile(), 0};
  }
}

namespace {

void add(Canvases::PostedAreas& to, const std::string& name, const Extent& extent) {
  if (to.size() >= Canvases::kMostNames && !to.contains(name)) {
    to[Canvases::kAnyName] = Extent::infinite();
    return;
  }
  const auto [its, is_new] = to.try_emplace(name, extent);
  if (!is_new) its->second = bounding_box(its->second, extent);
}

void add(Canvases::PostedAreas& to, const Canvases::PostedAreas& from) {
  for (const auto& [name, extent] : from) add(to, name, extent);
}

/// Where grids of that name are, or may be; nothing if there are none.
std::optional<Extent> extent_in(const Canvases::PostedAreas& sent, const std::string& name) {
  std::optional<Extent> all;
  for (const std::string& key : {std::string(Canvases::kAnyName), name}) {
    const auto found = sent.find(key);
    if (found != sent.end()) all = all ? bounding_box(*all, found->second) : found->second;
  }
  return all;
}

}  // namespace

void Canvases::restore(PostedAreas before) {
  before_ = posted_ = std::move(before);
  sent_.clear();
}

void Canvases::lead_to(std::string command_post) {
  command_post_ = std::move(command_post);
  canvases_.clear();
}

std::optional<std::pair<std::string, Extent>> Canvases::grows(const icd::MapUpdate& grid) const {
  if (posted_.contains(kAnyName)) return {};
  const std::string name = icd::text_of(grid.name);
  const Extent extent = extent_of(std::get<icd::OccupancyGrid>(grid.msg));
  const auto before = posted_.find(name);
  if (before == posted_.end() && posted_.size() >= kMostNames) return {{kAnyName, Extent::infinite()}};
  if (before == posted_.end()) return {{name, extent}};
  if (before->second.holds(extent)) return {};
  return {{name, bounding_box(before->second, extent)}};
}

/// Grids of an earlier process may have arrived just before this process start.
Canvases::SentGrids& Canvases::present_grids() {
  const auto found = sent_.find(command_post_);
  if (found != sent_.end()) return found->second;
  return sent_.emplace(command_post_, SentGrids{.all = before_, .newer = before_, .older = {}}).first->second;
}

void Canvases::on_status(std::span<const icd::MapUpdate* const> under_way) {
  PostedAreas newer;
  for (const icd::MapUpdate* map : under_way) {
    if (map->is_grid())
      add(newer, icd::text_of(map->name), extent_of(std::get<icd::OccupancyGrid>(map->msg)));
  }
  SentGrids& sent = present_grids();
  sent.older = std::exchange(sent.newer, std::move(newer));
}

/// A later process also treats grids of earlier runs as sent, because it does not know when the runs ended.
void Canvases::begin_run() {
  canvases_.clear();
  SentGrids& sent = present_grids();
  PostedAreas all = sent.older;
  add(all, sent.newer);
  sent.all = std::move(all);
}

void Canvases::resume_run() {
  canvases_.clear();
  add(present_grids().all, posted_);
}

const Canvas* Canvases::find(const std::optional<icd::RobotName>& name) const {
  const auto found = canvases_.find(name);
  return found == canvases_.end() ? nullptr : &found->second;
}

/// A whole map that grows is not drawn, because it covers all grids that could be stitched to it.
void Canvases::on_send(QueuedMap& next) {
  const auto& grid = std::get<icd::OccupancyGrid>(next.map.msg);
  const Extent extent = extent_of(grid);
  const std::string name = icd::text_of(next.map.name);
  SentGrids& sent = present_grids();
  const std::optional<Extent> before = extent_in(sent.all, name);
  add(sent.newer, name, extent);
  add(sent.all, name, extent);

  auto its = canvases_.find(next.map.name);
  const bool is_whole_map = next.parts.empty() && before && extent.holds(*before);
  const bool is_drawn = Canvas::can_draw(grid) && !is_whole_map;
  if (its != canvases_.end() && (!is_drawn || !its->second.cells_of(grid))) {
    canvases_.erase(its);
    its = canvases_.end();
  }
  if (!is_drawn || (its == canvases_.end() && canvases_.size() >= kMostNames)) return;
  if (its == canvases_.end()) its = canvases_.emplace(next.map.name, Canvas(++numbers_, grid, before)).first;
  const auto cells = its->second.cells_of(grid);
  if (!cells) return;
  auto ground = can_join(next) ? std::make_shared<const Ground>(its->second.ground_at(*cells)) : nullptr;
  its->second.forget(*cells);
  next.ground = std::move(ground);
}

void Canvases::lay(const std::optional<icd::RobotName>& name, const Ground& drawn) {
  const auto found = canvases_.find(name);
  if (found == canvases_.end() || found->second.number() != drawn.canvas) return;
  found->second.lay(drawn, ++laid_);
  forget_oldest();
}

/// Forgets a quarter at once, so that this is rare.
void Canvases::forget_oldest() {
  std::vector<std::uint64_t> when;
  std::size_t all = 0;
  for (const auto& [name, canvas] : canvases_) {
    canvas.add_times(when);
    all += canvas.tiles();
  }
  if (all > kMostForgotten) return canvases_.clear();
  if (when.size() <= most_tiles_) return;
  const auto first_kept = when.begin() + static_cast<std::ptrdiff_t>(when.size() - most_tiles_ / 4 * 3);
  std::ranges::nth_element(when, first_kept);
  for (auto& [name, canvas] : canvases_) canvas.forget_before(*first_kept);
}

}  // namespace adit::queues
