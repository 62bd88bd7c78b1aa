#include "picture/coverage.hpp"

#include <algorithm>
#include <memory>

#include "picture/tile.hpp"

namespace adit::picture {
namespace {

std::uint32_t known_in(const Pixels& pixels) {
  return static_cast<std::uint32_t>(pixels.size()) -
         static_cast<std::uint32_t>(std::ranges::count(pixels, std::uint8_t{0}));
}

/// The known pixels of several tiles of one place.
class Union {
 public:
  void clear() { all_.fill(0); }
  /// Returns the tile's own number of known pixels.
  std::uint32_t add(const PackedTile& tile) {
    packer_.unpack(tile, pixels_);
    for (std::size_t i = 0; i < all_.size(); ++i) all_[i] |= pixels_[i];
    return known_in(pixels_);
  }
  std::uint32_t known_count() const { return known_in(all_); }

 private:
  Packer packer_;
  Pixels pixels_{}, all_{};
};

}  // namespace

CoveredArea::Changes CoveredArea::changes(const Mosaic& mosaic) const {
  Changes changes{.places = {}, .version = mosaic.version(), .is_whole = mosaic.has_all_grids()};
  for (const auto& [at, histories] : mosaic.grid_places(version_)) {
    auto& tiles = changes.places[at];
    for (const auto& [robot, history] : histories) {
      if (const Tile& tile = history->newest().tile) tiles.emplace_back(robot, tile);
    }
  }
  return changes;
}

void CoveredArea::update(const Changes& changes, const Between& between) {
  const auto seen = std::make_unique<Union>();
  for (const auto& [at, tiles] : changes.places) {
    Counts counts;
    seen->clear();
    for (const auto& [robot, tile] : tiles) {
      counts.of.emplace_back(robot, seen->add(*tile));
      between();
    }
    counts.all = seen->known_count();
    places_[at] = std::move(counts);
  }
  version_ = changes.version;
  is_whole_ = changes.is_whole;
}

Coverage CoveredArea::now() const {
  Coverage covered{.version = version_, .of = {}, .all = 0, .is_whole = is_whole_};
  for (const auto& [at, counts] : places_) {
    covered.all += counts.all;
    for (const auto& [robot, known] : counts.of) covered.of[robot] += known;
  }
  return covered;
}

std::vector<std::pair<double, std::uint64_t>> covered_over_time(const Mosaic& mosaic) {
  std::map<double, std::uint64_t> more;  // newly known pixels by time
  const auto seen = std::make_unique<Union>();
  for (const auto& [at, histories] : mosaic.grid_places(0)) {
    std::vector<const Version*> states;
    for (const auto& [robot, history] : histories) {
      for (const Version& state : history->versions()) {
        if (state.tile) states.push_back(&state);
      }
    }
    std::ranges::stable_sort(states, {}, &Version::stamp);
    seen->clear();
    std::uint64_t known = 0;
    for (const Version* state : states) {
      seen->add(*state->tile);
      more[state->stamp] += seen->known_count() - std::exchange(known, seen->known_count());
    }
  }
  std::vector<std::pair<double, std::uint64_t>> all{more.begin(), more.end()};
  for (std::size_t i = 1; i < all.size(); ++i) all[i].second += all[i - 1].second;
  return all;
}

}  // namespace adit::picture
