#include "forward/fine_tiles.hpp"

#include <algorithm>
#include <utility>

#include "icd/refuse.hpp"

namespace adit::forward {
namespace {

/// The base tile around it.
picture::TileIndex base_of(picture::TileIndex at) {
  while (at.level < 0) at = picture::coarser(at);
  return at;
}

std::size_t bytes_of(const picture::FineBlock& tiles) {
  std::size_t bytes = sizeof tiles;
  for (const picture::Tile& tile : tiles) bytes += picture::cost_of({.tile = tile});
  return bytes;
}

}  // namespace

struct FineTiles::Job {
  Place place;
  Of of;
  std::vector<Asker> askers;
  std::vector<std::shared_ptr<const picture::ForwardedGrid>> grids;
  std::optional<picture::FineBlock> tiles{};
};

void FineTiles::clear() {
  grids_.clear();
  drawn_.clear();
  drawn_bytes_ = 0;
}

FineTiles::Of FineTiles::of(const Place& place) const {
  return {.newest = grids_.newest_in(place.layer, picture::area_of(place.over)),
          .base = mosaic_.tile(place.layer, base_of(place.over), {}).tile};
}

const picture::FineBlock* FineTiles::found(const Place& place, const Of& of) {
  const auto found = drawn_.find(place);
  if (found == drawn_.end() || found->second.of != of) return nullptr;
  found->second.used = ++uses_;
  return &found->second.tiles;
}

void FineTiles::tile(const picture::Layer& layer, const picture::TileIndex& at, Done done) {
  const Place place{layer, picture::coarser(at)};
  const Of now = of(place);
  const auto finer = grids_.finer(layer, 0);
  if (now.newest == 0 || !finer || at.level < finer->level) return done(nullptr);
  if (const auto* tiles = found(place, now)) return done((*tiles)[picture::place_in_block(at)]);
  std::size_t waiting = 0;
  for (const auto& [each, askers] : askers_) waiting += askers.size();
  if (waiting == kMostAskers)
    return done(icd::refuse(icd::Status::ServiceUnavailable, "too many requests for tiles; try again later"));
  auto& askers = askers_[place];
  if (askers.empty()) waiting_.push_back(place);
  askers.push_back({at, std::move(done)});
  pump();
}

void FineTiles::pump() {
  while (!is_drawing_ && !waiting_.empty()) {
    const Place place = std::move(waiting_.front());
    waiting_.pop_front();
    auto askers = std::move(askers_[place]);
    askers_.erase(place);
    Of now = of(place);
    const auto* tiles = found(place, now);
    if (tiles == nullptr) return draw(place, std::move(now), std::move(askers));
    for (const Asker& asker : askers) asker.done((*tiles)[picture::place_in_block(asker.at)]);
  }
}

/// Later requests wait for the next block, because a grid may arrive.
void FineTiles::draw(const Place& place, Of of, std::vector<Asker> askers) {
  is_drawing_ = true;
  const auto job = std::make_shared<Job>(Job{.place = place,
                                             .of = std::move(of),
                                             .askers = std::move(askers),
                                             .grids = grids_.in(place.layer, picture::area_of(place.over))});
  workers_.submit(
      loop::Urgency::CanWait,
      [job, &workers = workers_] {  // workers outlive the jobs
        job->tiles = picture::draw_fine_from_base(job->askers.front().at, job->grids, job->of.base,
                                                  [&workers] { workers.give_way(); });
        job->grids.clear();
      },
      [this, job] { drawn(*job); });
}

void FineTiles::drawn(const Job& job) {
  is_drawing_ = false;
  if (job.tiles) keep(job.place, job.of, *job.tiles);
  for (const Asker& asker : job.askers) {
    if (job.tiles) {
      asker.done((*job.tiles)[picture::place_in_block(asker.at)]);
    } else {
      asker.done(icd::refuse(icd::Status::ServiceUnavailable, "no memory"));
    }
  }
  pump();
}

void FineTiles::keep(const Place& place, const Of& of, const picture::FineBlock& tiles) {
  Drawn& drawn = drawn_[place];
  drawn_bytes_ -= drawn.bytes;
  drawn = {.of = of, .tiles = tiles, .bytes = bytes_of(tiles), .used = ++uses_};
  drawn_bytes_ += drawn.bytes;
  while (drawn_bytes_ > kMostDrawn && drawn_.size() > 1) {
    const auto oldest =
        std::ranges::min_element(drawn_, {}, [](const auto& each) { return each.second.used; });
    drawn_bytes_ -= oldest->second.bytes;
    drawn_.erase(oldest);
  }
}

}  // namespace adit::forward
