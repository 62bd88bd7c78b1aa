#include "archive/due_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace adit::archive {

double DueTiles::interval_of(int level) {
  constexpr double kFinest = 4;
  return kFinest * std::pow(4, level);
}

void DueTiles::look(const picture::Mosaic& picture) {
  if (picture.version() == seen_) return;
  for (const picture::LayerView& layer : picture.layers(seen_)) {
    for (const picture::TileView& tile : layer.tiles) {
      Tile& known = tiles_[{layer.layer, tile.at}];
      // A blank tile belongs to an earlier run, unless this run wrote it.
      known.due = !tile.blank || known.written != 0;
    }
  }
  seen_ = picture.version();
}

std::vector<TileKey> DueTiles::at(double now) const {
  std::vector<std::pair<double, const TileKey*>> order;
  for (const auto& [key, tile] : tiles_) {
    const bool rests = tile.written != 0 && now < tile.written + interval_of(key.second.level);
    if (tile.due && !rests) order.emplace_back(tile.written, &key);
  }
  std::ranges::stable_sort(order, {}, &std::pair<double, const TileKey*>::first);
  std::vector<TileKey> keys;
  keys.reserve(order.size());
  for (const auto& [written, key] : order) keys.push_back(*key);
  return keys;
}

void DueTiles::being_written(const TileKey& tile, std::uint64_t write, double now) {
  Tile& its = tiles_[tile];
  its.written = now;
  its.write = write;
  its.due = false;
}

void DueTiles::done(std::uint64_t write, std::optional<std::uint64_t> file) {
  for (auto& [at, tile] : tiles_) {
    if (tile.write != write) continue;
    tile.write = 0;
    if (file) tile.file = *file;
    if (!file) tile.due = true;
  }
}

bool DueTiles::leave(std::uint64_t file) {
  bool holds_any = false;
  for (auto& [at, tile] : tiles_) {
    if (tile.file != file) continue;
    tile.due = true;
    holds_any = true;
  }
  return !holds_any;
}

void DueTiles::begin(const picture::Mosaic& picture, const std::map<TileKey, std::uint64_t>& files) {
  tiles_.clear();
  seen_ = 0;
  look(picture);
  for (const auto& [tile, file] : files) tiles_[tile] = {.written = 1, .file = file};
}

}  // namespace adit::archive
