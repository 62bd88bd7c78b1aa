#include "picture/mosaic.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "icd/require.hpp"

namespace adit::picture {
namespace {

bool share_span(double a, double b, double spacing) {
  return std::floor(a / spacing) == std::floor(b / spacing);
}

}  // namespace

std::size_t cost_of(const Version& version) {
  constexpr std::size_t kAllocation = 32;  // overhead of an allocation
  const std::size_t own = sizeof(Version) + kAllocation;
  return version.tile ? own + sizeof(PackedTile) + kAllocation + version.tile->deflated.size() : own;
}

void History::add(Version version, double spacing) {
  icd::require(versions_.empty() || version.stamp >= newest().stamp);
  if (!versions_.empty() && share_span(newest().stamp, version.stamp, spacing)) {
    cost_ -= cost_of(newest());
    versions_.pop_back();
  }
  cost_ += cost_of(version);
  versions_.push_back(std::move(version));
}

void History::thin(double spacing) {
  std::vector<Version> all;
  all.swap(versions_);
  cost_ = 0;
  for (Version& version : all) add(std::move(version), spacing);
  versions_.shrink_to_fit();
}

const Version* History::at(double stamp) const {
  const auto after = std::ranges::upper_bound(versions_, stamp, {}, &Version::stamp);
  return after == versions_.begin() ? nullptr : &*(after - 1);
}

std::optional<double> History::end_of(const Version& version) const {
  const auto after = std::ranges::upper_bound(versions_, version.stamp, {}, &Version::stamp);
  return after == versions_.end() ? std::nullopt : std::optional(after->stamp);
}

namespace {

/// Longer than any time since 1970: one span for all.
constexpr double kForever = 1e11;

void extend(std::optional<Heights>& heights, const std::optional<Heights>& more) {
  if (!more) return;
  if (!heights) heights = more;
  *heights = {std::min(heights->low, more->low), std::max(heights->high, more->high)};
}

}  // namespace

Canvas Mosaic::canvas(const Layer& layer) const {
  Canvas canvas{.run = run_, .tiles = {}};
  const auto found = layers_.find(layer);
  if (found == layers_.end()) return canvas;
  for (const auto& [at, history] : found->second.tiles) {
    if (const Tile& tile = history.newest().tile) canvas.tiles.emplace_hint(canvas.tiles.end(), at, tile);
  }
  return canvas;
}

/// Null if the layer is new and there are kMostLayers already.
Mosaic::State* Mosaic::state_of(const Layer& layer, double stamp) {
  const auto found = layers_.find(layer);
  if (found != layers_.end()) return &found->second;
  if (layers_.size() == kMostLayers) return nullptr;
  State& state = layers_[layer];
  state.view.layer = layer;
  state.view.first = state.view.last = stamp;
  return &state;
}

/// Starts a change and returns its time: finite, and not before the last one.
double Mosaic::begin_change(double stamp) {
  constexpr double kLatest = 1e11;
  if (stamp > last_) last_ = std::min(stamp, kLatest);
  version_ = std::max(version_ + 1, static_cast<std::uint64_t>(last_ * 1000));
  return last_;
}

bool Mosaic::has_room(const State& state, const Drawing& drawing) const {
  std::size_t more = 0, less = 0;
  for (const auto& [at, tile] : drawing.tiles) {
    more += cost_of({.tile = tile});
    const auto found = state.tiles.find(at);
    if (found != state.tiles.end()) less += cost_of(found->second.newest());
  }
  return newest_bytes_ + more - less <= budget_;
}

bool Mosaic::apply(Drawing drawing, double stamp) {
  if (drawing.run != run_) return false;
  State* state = state_of(drawing.layer, stamp);
  if (state == nullptr || !has_room(*state, drawing)) {
    ++(state == nullptr ? missed_ : state->view.missed);
    return false;
  }
  const double now = drawing.tiles.empty() ? std::max(stamp, last_) : begin_change(stamp);
  state->view.last = std::max(state->view.last, now);
  state->view.left_out = drawing.left_out;
  if (drawing.area) extend(state->view.bounds, *drawing.area);
  extend(state->view.heights, drawing.heights);
  if (drawing.tiles.empty()) return true;
  state->view.version = version_;
  for (auto& [at, tile] : drawing.tiles) put(*state, at, std::move(tile), now);
  keep_to_budget();
  return true;
}

void Mosaic::on_missed(const Layer& layer, double stamp) {
  State* state = state_of(layer, stamp);
  ++(state == nullptr ? missed_ : state->view.missed);
}

void Mosaic::wipe(double stamp) {
  const double now = begin_change(stamp);
  ++run_;
  wiped_ = now;
  missed_ = 0;
  for (auto& [layer, state] : layers_) {
    state.view.bounds.reset();
    state.view.heights.reset();
    state.view.missed = state.view.left_out = 0;
    state.view.version = version_;
    for (auto& [at, history] : state.tiles) {
      if (history.newest().tile) put(state, at, nullptr, now);
    }
  }
  keep_to_budget();
}

void Mosaic::move(double seconds) {
  last_ += seconds;
  if (wiped_) *wiped_ += seconds;
  for (auto& [layer, state] : layers_) {
    state.view.first += seconds;
    state.view.last += seconds;
    for (auto& [at, history] : state.tiles) history.move(seconds);
  }
}

void Mosaic::put(State& state, const TileIndex& at, Tile tile, double stamp) {
  History& history = state.tiles[at];
  if (!history.empty()) newest_bytes_ -= cost_of(history.newest());
  bytes_ -= history.cost();
  history.add({stamp, version_, std::move(tile)}, spacing_);
  bytes_ += history.cost();
  newest_bytes_ += cost_of(history.newest());
}

void Mosaic::keep_to_budget() {
  while (bytes_ > budget_ && spacing_ < kForever) {
    spacing_ *= 2;
    bytes_ = 0;
    for (auto& [layer, state] : layers_) {
      for (auto& [at, history] : state.tiles) {
        history.thin(spacing_);
        bytes_ += history.cost();
      }
    }
  }
}

Mosaic::ShownTile Mosaic::tile(const Layer& layer, const TileIndex& at, std::optional<double> stamp) const {
  const auto state = layers_.find(layer);
  if (state == layers_.end()) return {};
  const auto found = state->second.tiles.find(at);
  if (found == state->second.tiles.end()) return {};
  const History& history = found->second;
  const Version* version = stamp ? history.at(*stamp) : &history.newest();
  if (version == nullptr) return {};
  return {version->tile, version == &history.newest(), version->stamp, history.end_of(*version)};
}

std::map<TileIndex, std::vector<std::pair<std::string, const History*>>> Mosaic::grid_places(
    std::uint64_t since) const {
  std::map<TileIndex, std::vector<std::pair<std::string, const History*>>> places;
  const auto for_each = [&](auto visit) {
    for (const auto& [layer, state] : layers_) {
      if (layer.kind != LayerKind::Grid) continue;
      for (const auto& [at, history] : state.tiles) {
        if (at.level > 0) break;  // they are sorted by level
        visit(layer.robot, at, history);
      }
    }
  };
  for_each([&](const std::string&, const TileIndex& at, const History& history) {
    if (history.newest().number > since) places[at];
  });
  for_each([&](const std::string& robot, const TileIndex& at, const History& history) {
    if (const auto place = places.find(at); place != places.end())
      place->second.emplace_back(robot, &history);
  });
  return places;
}

bool Mosaic::has_all_grids() const {
  return missed_ == 0 && std::ranges::all_of(layers_, [](const auto& each) {
           const LayerView& view = each.second.view;
           return view.layer.kind != LayerKind::Grid || (view.missed == 0 && view.left_out == 0);
         });
}

std::vector<LayerView> Mosaic::layers(std::uint64_t since) const {
  std::vector<LayerView> views;
  views.reserve(layers_.size());
  for (const auto& [layer, state] : layers_) {
    LayerView& view = views.emplace_back(state.view);
    for (const auto& [at, history] : state.tiles) {
      const Version& newest = history.newest();
      if (newest.number <= since) continue;
      view.tiles.push_back({.at = at,
                            .first = history.first().stamp,
                            .stamp = newest.stamp,
                            .version = newest.number,
                            .blank = newest.tile == nullptr});
    }
  }
  return views;
}

bool Mosaic::restore(const Layer& layer, const TileIndex& at, Tile tile, double stamp) {
  State* state = state_of(layer, stamp);
  if (state == nullptr) return false;
  const auto found = state->tiles.find(at);
  if (found != state->tiles.end() && found->second.newest().stamp > stamp) return false;
  Drawing drawing{.layer = layer, .run = run_, .tiles = {}, .area = {}, .heights = {}};
  if (tile) drawing.tiles.emplace_back(at, tile);
  if (!has_room(*state, drawing)) {
    ++state->view.missed;
    return false;
  }
  begin_change(stamp);
  state->view.version = version_;
  state->view.last = std::max(state->view.last, stamp);
  put(*state, at, std::move(tile), stamp);
  keep_to_budget();
  return true;
}

void Mosaic::restore(const LayerView& view) {
  State* state = state_of(view.layer, view.first);
  if (state == nullptr) return;
  LayerView& own = state->view;
  own.first = std::min(own.first, view.first);
  own.last = std::max(own.last, view.last);
  if (view.bounds) extend(own.bounds, *view.bounds);
  if (view.heights) own.heights = view.heights;
  own.missed = view.missed;
  own.left_out = view.left_out;
}

void Mosaic::restore(Mosaic earlier, double stamp) {
  if (earlier.layers_.empty()) return;
  last_ = std::max(last_, earlier.last_);  // the time of day may have been set back since
  const double now = begin_change(stamp);
  spacing_ = std::max(spacing_, earlier.spacing_);
  if (!wiped_) wiped_ = earlier.wiped_;
  for (auto& [layer, its] : earlier.layers_) {
    State* state = state_of(layer, its.view.first);
    if (state == nullptr) continue;
    restore(its.view);
    state->view.version = version_;
    for (auto& [at, history] : its.tiles) restore(*state, at, history, now);
  }
  keep_to_budget();
}

/// A tile that exists here keeps its history, as a wiped tile has states of another run, which cannot follow.
void Mosaic::restore(State& state, const TileIndex& at, const History& earlier, double stamp) {
  const auto found = state.tiles.find(at);
  if (found != state.tiles.end()) {
    if (!found->second.newest().tile) put(state, at, earlier.newest().tile, stamp);
    return;
  }
  History& taken = state.tiles[at] = earlier;
  taken.renumber(version_);
  bytes_ += taken.cost();
  newest_bytes_ += cost_of(taken.newest());
}

}  // namespace adit::picture
