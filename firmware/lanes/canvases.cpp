#include "lanes/canvases.hpp"

#include <algorithm>
#include <vector>

namespace adit::lanes {
namespace {

std::string text_of(const std::optional<icd::RobotName>& name) {
  return name ? name->text() : "";
}

}  // namespace

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

/// That name at this Command Post.
std::string Canvases::here(const std::optional<icd::RobotName>& name) const {
  return text_of(name) + '@' + command_post_;
}

/// Where something of that name was sent, or may have been; nothing: nowhere.
std::optional<Extent> Canvases::sent(const std::optional<icd::RobotName>& name) const {
  std::optional<Extent> all;
  const auto add = [&](const std::map<std::string, Extent>& extents, const std::string& key) {
    const auto found = extents.find(key);
    if (found != extents.end()) all = all ? around(*all, found->second) : found->second;
  };
  if (!began_.contains(command_post_)) {
    add(before_, kAnyName);
    add(before_, text_of(name));
  }
  add(sent_, kAnyName);
  add(sent_, here(name));
  return all;
}

void Canvases::note(const std::optional<icd::RobotName>& name, const Extent& extent) {
  const std::string key = here(name);
  if (sent_.size() >= kMostNames && !sent_.contains(key)) {
    sent_[kAnyName] = Extent::everywhere();
    return;
  }
  const auto [its, is_new] = sent_.try_emplace(key, extent);
  if (!is_new) its->second = around(its->second, extent);
}

/// A life to come takes for sent what was posted in earlier runs, too: it does not know when they ended.
void Canvases::begin_run(std::span<const icd::MapUpdate* const> under_way) {
  canvases_.clear();
  began_.insert(command_post_);
  std::erase_if(sent_, [&](const auto& sent) { return sent.first.ends_with('@' + command_post_); });
  for (const icd::MapUpdate* map : under_way) {
    if (!map->is_grid()) continue;
    note(map->name, extent_of(std::get<icd::OccupancyGrid>(map->msg)));
  }
}

const Canvas* Canvases::find(const std::optional<icd::RobotName>& name) const {
  const auto found = canvases_.find(name);
  return found == canvases_.end() ? nullptr : &found->second;
}

/// A whole map that grows is not drawn: nothing is ever stitched to it that it does not cover.
void Canvases::sends(WaitingMap& next) {
  const auto& grid = std::get<icd::OccupancyGrid>(next.map.msg);
  const Extent extent = extent_of(grid);
  const std::optional<Extent> before = sent(next.map.name);
  note(next.map.name, extent);

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

/// Down to three quarters, so that this is done now and then.
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

}  // namespace adit::lanes
