#include "queues/canvases.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace adit::queues {
namespace {

std::string text_of(const std::optional<icd::RobotName>& name) {
  return name ? name->text() : "";
}

void add(Canvases::Posted& to, const std::string& name, const Extent& extent) {
  if (to.size() >= Canvases::kMostNames && !to.contains(name)) {
    to[Canvases::kAnyName] = Extent::everywhere();
    return;
  }
  const auto [its, is_new] = to.try_emplace(name, extent);
  if (!is_new) its->second = around(its->second, extent);
}

void add(Canvases::Posted& to, const Canvases::Posted& from) {
  for (const auto& [name, extent] : from) add(to, name, extent);
}

/// Where grids of that name are, or may be; nothing if there are none.
std::optional<Extent> extent_in(const Canvases::Posted& sent, const std::string& name) {
  std::optional<Extent> all;
  for (const std::string& key : {std::string(Canvases::kAnyName), name}) {
    const auto found = sent.find(key);
    if (found != sent.end()) all = all ? around(*all, found->second) : found->second;
  }
  return all;
}

}  // namespace

void Canvases::carry_on(Posted before) {
  before_ = posted_ = std::move(before);
  sent_.clear();
}

void Canvases::lead_to(std::string command_post) {
  command_post_ = std::move(command_post);
  canvases_.clear();
}

std::optional<std::pair<std::string, Extent>> Canvases::grows(const icd::MapUpdate& grid) const {
  if (posted_.contains(kAnyName)) return {};
  const std::string name = text_of(grid.name);
  const Extent extent = extent_of(std::get<icd::OccupancyGrid>(grid.msg));
  const auto before = posted_.find(name);
  if (before == posted_.end() && posted_.size() >= kMostNames) return {{kAnyName, Extent::everywhere()}};
  if (before == posted_.end()) return {{name, extent}};
  if (before->second.holds(extent)) return {};
  return {{name, around(before->second, extent)}};
}

/// Grids of an earlier process may have arrived just before this process start.
Canvases::Sent& Canvases::here() {
  const auto found = sent_.find(command_post_);
  if (found != sent_.end()) return found->second;
  return sent_.emplace(command_post_, Sent{.all = before_, .newer = before_, .older = {}}).first->second;
}

void Canvases::heard(std::span<const icd::MapUpdate* const> under_way) {
  Posted newer;
  for (const icd::MapUpdate* map : under_way) {
    if (map->is_grid()) add(newer, text_of(map->name), extent_of(std::get<icd::OccupancyGrid>(map->msg)));
  }
  Sent& sent = here();
  sent.older = std::exchange(sent.newer, std::move(newer));
}

/// A later process also treats grids of earlier runs as sent, because it does not know when the runs ended.
void Canvases::begin_run() {
  canvases_.clear();
  Sent& sent = here();
  Posted all = sent.older;
  add(all, sent.newer);
  sent.all = std::move(all);
}

void Canvases::take_up_run() {
  canvases_.clear();
  add(here().all, posted_);
}

const Canvas* Canvases::find(const std::optional<icd::RobotName>& name) const {
  const auto found = canvases_.find(name);
  return found == canvases_.end() ? nullptr : &found->second;
}

/// A whole map that grows is not drawn, because it covers all grids that could be stitched to it.
void Canvases::sends(QueuedMap& next) {
  const auto& grid = std::get<icd::OccupancyGrid>(next.map.msg);
  const Extent extent = extent_of(grid);
  const std::string name = text_of(next.map.name);
  Sent& sent = here();
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
  auto ground = may_join(next) ? std::make_shared<const Ground>(its->second.under(*cells)) : nullptr;
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
