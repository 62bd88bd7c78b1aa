// Restores a picture from a saved one.
#include <algorithm>
#include <utility>

#include "picture/mosaic.hpp"

namespace adit::picture {

bool Mosaic::take_up(const Layer& layer, const TileIndex& at, Tile tile, double stamp) {
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

void Mosaic::take_up(const LayerView& view) {
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

void Mosaic::take_up(Mosaic earlier, double stamp) {
  if (earlier.layers_.empty()) return;
  last_ = std::max(last_, earlier.last_);  // the time of day may have been set back since
  const double now = begin_change(stamp);
  spacing_ = std::max(spacing_, earlier.spacing_);
  if (!wiped_) wiped_ = earlier.wiped_;
  for (auto& [layer, its] : earlier.layers_) {
    State* state = state_of(layer, its.view.first);
    if (state == nullptr) continue;
    take_up(its.view);
    state->view.version = version_;
    for (auto& [at, history] : its.tiles) take_up(*state, at, history, now);
  }
  keep_to_budget();
}

/// The history of a tile that exists here is not extended: a wiped tile has states of another run, and no
/// state can be inserted before them.
void Mosaic::take_up(State& state, const TileIndex& at, const History& earlier, double stamp) {
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
