#include "forward/map_picture.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "host/log.hpp"
#include "icd/sentence.hpp"

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
  BlockKey place;
  BlockSource of;
  std::vector<Asker> askers;
  std::vector<std::shared_ptr<const picture::ForwardedGrid>> grids;
  std::optional<picture::FineBlock> tiles{};
};

void FineTiles::clear() {
  grids_.clear();
  drawn_.clear();
  drawn_bytes_ = 0;
}

FineTiles::BlockSource FineTiles::areas_at(const BlockKey& place) const {
  return {.newest = grids_.newest_in(place.layer, picture::area_of(place.over)),
          .base = mosaic_.tile(place.layer, base_of(place.over), {}).tile};
}

const picture::FineBlock* FineTiles::find_block(const BlockKey& place, const BlockSource& of) {
  const auto found = drawn_.find(place);
  if (found == drawn_.end() || found->second.of != of) return nullptr;
  found->second.used = ++uses_;
  return &found->second.tiles;
}

void FineTiles::tile(const picture::Layer& layer, const picture::TileIndex& at, Done done) {
  const BlockKey place{layer, picture::coarser(at)};
  const BlockSource now = areas_at(place);
  const auto finer = grids_.finer_levels(layer, 0);
  if (now.newest == 0 || !finer || at.level < finer->level) return done(nullptr);
  if (const auto* tiles = find_block(place, now)) return done((*tiles)[picture::place_in_block(at)]);
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
    const BlockKey place = std::move(waiting_.front());
    waiting_.pop_front();
    auto askers = std::move(askers_[place]);
    askers_.erase(place);
    BlockSource now = areas_at(place);
    const auto* tiles = find_block(place, now);
    if (tiles == nullptr) return draw(place, std::move(now), std::move(askers));
    for (const Asker& asker : askers) asker.done((*tiles)[picture::place_in_block(asker.at)]);
  }
}

/// Later requests wait for the next block, because a grid may arrive.
void FineTiles::draw(const BlockKey& place, BlockSource of, std::vector<Asker> askers) {
  is_drawing_ = true;
  const auto job =
      std::make_shared<Job>(Job{.place = place,
                                .of = std::move(of),
                                .askers = std::move(askers),
                                .grids = grids_.grids_in(place.layer, picture::area_of(place.over))});
  workers_.submit(
      loop::Urgency::CanWait,
      [job, &workers = workers_] {  // workers outlive the jobs
        job->tiles = picture::draw_fine_from_base(job->askers.front().at, job->grids, job->of.base,
                                                  [&workers] { workers.give_way(); });
        job->grids.clear();
      },
      [this, job] { on_drawn(*job); });
}

void FineTiles::on_drawn(const Job& job) {
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

void FineTiles::keep(const BlockKey& place, const BlockSource& of, const picture::FineBlock& tiles) {
  CachedBlock& drawn = drawn_[place];
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

namespace {

/// Nothing for clouds: none replaces another, because senders post new points only.
std::optional<icd::GridBounds> bounds_of(const icd::MapUpdate& map) {
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&map.msg);
  return grid == nullptr ? std::nullopt : std::optional(icd::GridBounds::from_grid(*grid));
}

}  // namespace

struct CoveredCount::Job {
  std::vector<Done> askers;
  picture::CoveredArea::Changes changes;
  std::optional<picture::Coverage> covered{};
};

void CoveredCount::count(Done done) {
  if (askers_.size() == kMostAskers)
    return done(
        icd::refuse(icd::Status::ServiceUnavailable, "too many requests for the area; try again later"));
  askers_.push_back(std::move(done));
  if (!is_counting_) pump();
}

/// Later requests wait for the next count, because the map may change.
void CoveredCount::pump() {
  if (askers_.empty()) return;
  is_counting_ = true;
  const auto job =
      std::make_shared<Job>(Job{.askers = std::exchange(askers_, {}), .changes = area_->changes(mosaic_)});
  workers_.submit(
      loop::Urgency::CanWait,
      [job, area = area_, &workers = workers_] {  // workers outlive the jobs
        area->update(job->changes, [&workers] { workers.give_way(); });
        job->covered = area->now();
        job->changes.places.clear();
      },
      [this, job] { on_counted(*job); });
}

void CoveredCount::on_counted(const Job& job) {
  is_counting_ = false;
  for (const Done& done : job.askers) {
    if (job.covered) {
      done(*job.covered);
    } else {
      done(icd::refuse(icd::Status::ServiceUnavailable, "no memory"));
    }
  }
  if (!is_counting_) pump();
}

struct MapPicture::Job {
  QueuedDrawing waiting;
  picture::Canvas canvas;
  icd::Checked<picture::Drawing> drawing = icd::refuse(icd::Status::ServiceUnavailable, "no memory");
  std::shared_ptr<const picture::ForwardedGrid> forwarded{};  // null for a cloud
};

MapPicture::MapPicture(loop::Loop& loop, loop::Workers& workers, std::function<void()> changed)
    : loop_(loop),
      workers_(workers),
      changed_(std::move(changed)),
      wake_(loop.timer([this] { pump(); })),
      fine_(workers, mosaic_),
      covered_(workers, mosaic_) {}

void MapPicture::on_forwarded(icd::MapUpdate map) {
  auto bounds = bounds_of(map);
  std::erase_if(waiting_, [&](const QueuedDrawing& older) {
    if (!bounds || !older.bounds || map.name != older.map.name) return false;
    if (!icd::covers(std::get<icd::OccupancyGrid>(map.msg), *older.bounds)) return false;
    bounds = icd::joint_bounds(*bounds, *older.bounds);
    waiting_bytes_ -= older.map.data.bytes.size();
    return true;
  });
  waiting_bytes_ += map.data.bytes.size();
  waiting_.push_back({.map = std::move(map), .stamp = loop_.wall_now(), .bounds = bounds});
  while (waiting_bytes_ > kMostWaiting && waiting_.size() > 1) {
    mosaic_.on_missed(picture::layer_of(waiting_.front().map), waiting_.front().stamp);
    waiting_bytes_ -= waiting_.front().map.data.bytes.size();
    waiting_.pop_front();
  }
  wake_.call_at(loop_.now());  // the next map may be packed first
}

void MapPicture::restore(picture::Mosaic earlier) {
  held_until_ = {};
  const auto before = mosaic_.version();
  mosaic_.restore(std::move(earlier), loop_.wall_now());
  if (mosaic_.version() != before) changed_();
  pump();
}

void MapPicture::begin_run() {
  waiting_.clear();
  waiting_bytes_ = 0;
  mosaic_.wipe(loop_.wall_now());
  fine_.clear();
  changed_();
}

void MapPicture::move(double seconds) {
  mosaic_.move(seconds);
  for (QueuedDrawing& waiting : waiting_) waiting.stamp += seconds;
  if (drawing_) *drawing_ += seconds;
}

void MapPicture::pump() {
  if (drawing_ || waiting_.empty()) return;
  if (loop_.now() < held_until_) return wake_.call_at(held_until_);
  QueuedDrawing next = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= next.map.data.bytes.size();
  draw(std::move(next));
}

void MapPicture::draw(QueuedDrawing waiting) {
  drawing_ = waiting.stamp;
  auto job = std::make_shared<Job>(Job{std::move(waiting), {}});
  job->canvas = mosaic_.canvas(picture::layer_of(job->waiting.map));
  workers_.submit(
      loop::Urgency::CanWait,
      [job, &workers = workers_] {  // workers outlive the jobs
        job->drawing = picture::draw(job->waiting.map, job->canvas, [&workers] { workers.give_way(); });
        job->forwarded = picture::forwarded_grid(job->waiting.map);
        job->waiting.map.data = {};  // unmapping takes milliseconds
      },
      [this, job] { on_drawn(*job); });
}

void MapPicture::on_drawn(Job& job) {
  const double stamp = *std::exchange(drawing_, std::nullopt);
  const picture::Layer layer = picture::layer_of(job.waiting.map);
  const auto before = mosaic_.version();
  if (job.drawing) {
    const bool is_applied = mosaic_.apply(std::move(*job.drawing), stamp);
    if (is_applied && job.forwarded && fine_.add(std::move(job.forwarded), mosaic_.version() + 1)) {
      mosaic_.count_change(stamp);
    }
  } else {
    mosaic_.on_missed(layer, stamp);
    host::log(host::Level::Warning, "cannot draw a map",
              {{"robot", layer.robot}, {"why", job.drawing.error().sentence}});
  }
  if (mosaic_.version() != before) changed_();
  pump();
}

}  // namespace adit::forward
