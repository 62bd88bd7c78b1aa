#include "forward/accepted_maps.hpp"

#include <algorithm>
#include <utility>

#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "pack/has_all_points.hpp"

namespace adit::forward {
namespace {

/// A map after whose packing processes ended. Alone, because a fault counts against all maps in one message.
queues::PackingRule rule_after(const spool::Spool::Ends& ends) {
  using enum queues::PackingRule;
  constexpr int kMost = spool::Spool::Ends::kMost;
  if (ends.others > kMost) return LastAsItIs;
  if (ends.others == kMost || ends.faults >= kMost) return Last;
  return ends.faults > 0 ? Alone : Any;
}

std::vector<pack::Tile> tiles_outside(const icd::OccupancyGrid& grid,
                                      std::span<const icd::GridBounds> newer) {
  std::vector<pack::Tile> tiles;
  for (const queues::Cells& cells : queues::cells_outside(grid, newer)) {
    tiles.push_back({.data = {},
                     .column = static_cast<std::size_t>(cells.x),
                     .row = static_cast<std::size_t>(cells.y),
                     .width = static_cast<std::size_t>(cells.width),
                     .height = static_cast<std::size_t>(cells.height)});
  }
  return tiles;
}

/// Makes the part of `grid` out of it that `tile` is.
void place(icd::OccupancyGrid& grid, const pack::Tile& tile) {
  const auto column = static_cast<std::int64_t>(tile.column), row = static_cast<std::int64_t>(tile.row);
  if (column > 0 || row > 0) grid.origin = queues::corner_at(grid, column, row).value_or(grid.origin);
  grid.width = static_cast<std::uint32_t>(tile.width);
  grid.height = static_cast<std::uint32_t>(tile.height);
}

}  // namespace

/// After a power cut the areas of earlier grids are unknown. The record that begins grids shows it.
void AcceptedMaps::carry_on(const journal::Carried& carried, bool ran_before) {
  queues::Canvases::Posted posted = carried.grids().value_or(queues::Canvases::Posted{});
  if (!carried.grids()) {
    const auto everywhere = queues::Extent::everywhere();
    const auto told =
        ran_before ? journal_.grids_posted(queues::Canvases::kAnyName, everywhere) : journal_.grids_begin();
    if (ran_before || !told) posted[queues::Canvases::kAnyName] = everywhere;
    are_grids_told_ = told.has_value();
  }
  queue_.canvases().carry_on(std::move(posted));
}

/// Journals posted areas, so that later processes know the cells that were never sent. False: not journaled,
/// do not accept the grid. If the start could not read the journal, it is left for the next process.
bool AcceptedMaps::is_told(const icd::MapUpdate& update) {
  if (!update.is_grid()) return true;
  if (!are_grids_told_) {
    const auto everywhere = queues::Extent::everywhere();
    are_grids_told_ = journal_.grids_posted(queues::Canvases::kAnyName, everywhere).has_value();
    if (!are_grids_told_) return false;
  }
  const auto grows = queue_.canvases().grows(update);
  if (!grows) return true;
  if (!journal_.grids_posted(grows->first, grows->second)) return false;
  queue_.canvases().grown(*grows);
  return true;
}

/// A full queue accepts replacing maps. If it is full by number alone, it accepts merging maps.
bool AcceptedMaps::has_room_for(const icd::MapUpdate& update, bool replaces) const {
  const std::size_t waiting = queue_.bytes() + store_.bytes();
  const std::size_t count = queue_.count() + store_.count();
  if (!replaces && count >= kMostMaps && (count >= kMostWithJoined || !queue_.joins(update))) return false;
  return replaces || waiting == 0 || waiting + update.data.bytes.size() <= settings_.queues.map_bytes;
}

void AcceptedMaps::take(const std::shared_ptr<Arrived>& map) {
  if (overtaken_.must_wait(map->upload)) return waiting_.push_back(map);
  icd::MapUpdate& update = map->update;
  const bool is_whole = queue_.clouds_of(queues::Sender::of(update)) == queues::Clouds::Whole;
  const auto newer = update.is_grid() || is_whole ? overtaken_.find_newer(update, map->upload)
                                                  : std::vector<icd::GridBounds>();
  const bool replaces = newer.empty() && queue_.replaces_any(update);
  if (!has_room_for(update, replaces)) {
    counts_.no_room(traffic_of(update), loop_.wall_now());
    return refuse(*map, {icd::Status::TooManyRequests,
                         icd::sentence("the queue is full: ", queue_.count() + store_.count(), " maps, ",
                                       (queue_.bytes() + store_.bytes()) / 1000000,
                                       " MB; this map was not accepted, send it again later")});
  }
  if (!is_told(update)) return refuse(*map, not_stored());
  overtaken_.begin(map->upload, !newer.empty());
  if (!newer.empty()) return leave_out(map, newer);
  // Newer grids and whole clouds need room beside the old one.
  const std::uint64_t of_its_own = update.is_grid() || is_whole ? update.data.bytes.size() : 0;
  const std::uint64_t spare =
      replaces ? 0 : std::max<std::uint64_t>(queue_.largest_replaceable(), of_its_own);
  store_.store(std::move(update), std::move(map->file), spare, /*again=*/false,
               [this, map](MapStore::Stored& stored) { this->stored(stored, *map); });
}

/// Queued now; the sender may know.
void AcceptedMaps::stored(MapStore::Stored& stored, Arrived& map) {
  if (stored.has_no_valid_point) {
    counts_.no_valid_point(traffic_of(*stored.map), map.upload.bytes, loop_.wall_now());
    store_.forget({&stored.number, 1});
    return end(map, {});
  }
  if (!stored.map) return refuse(map, std::move(stored.map.error()));
  map.update.name = stored.map->name;
  map.update.msg = stored.map->msg;
  queue(stored);
  accept(map);
}

void AcceptedMaps::queue(MapStore::Stored& stored) {
  const Traffic traffic = traffic_of(*stored.map);
  tell_clouds(*stored.map);
  const auto replaced = queue_.add(stored.number, std::move(*stored.map), loop_.now());
  counts_.replaced(traffic, replaced.numbers.size());
  store_.forget(replaced);
}

void AcceptedMaps::leave_out(const std::shared_ptr<Arrived>& map, std::span<const icd::GridBounds> newer) {
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&map->update.msg);
  if (grid != nullptr) map->tiles = tiles_outside(*grid, newer);
  if (map->tiles.empty()) {  // the Command Post has newer data, or will have it
    counts_.replaced(traffic_of(map->update), 1);
    return accept(*map);
  }
  map->cut = std::unexpected(not_stored());
  workers_.submit(
      loop::Urgency::OnTheWay,
      [map, width = grid->width] { map->cut = pack::cut(map->update.data, width, map->tiles); },
      [this, map] {
        if (!map->cut) return refuse(*map, std::move(map->cut.error()));
        map->update.data = {};
        store_next_tile(map);
      });
}

void AcceptedMaps::store_next_tile(const std::shared_ptr<Arrived>& map) {
  icd::MapUpdate part = map->update;
  place(std::get<icd::OccupancyGrid>(part.msg), map->tiles.back());
  part.data = std::move(map->tiles.back().data);
  map->tiles.pop_back();
  store_.store(std::move(part), nullptr, /*spare=*/0, /*again=*/false, [this, map](MapStore::Stored& stored) {
    if (!stored.map) {
      for (const MapStore::Stored& part : map->parts) store_.forget({&part.number, 1});
      return refuse(*map, std::move(stored.map.error()));
    }
    map->parts.push_back(std::move(stored));
    if (!map->tiles.empty()) return store_next_tile(map);
    for (MapStore::Stored& part : map->parts) queue(part);
    accept(*map);
  });
}

void AcceptedMaps::accept(Arrived& map) {
  counts_.accepted(traffic_of(map.update), map.upload.bytes, loop_.wall_now());
  overtaken_.record(map.update, map.upload);
  end(map, {});
  compare();
  queued_();
}

void AcceptedMaps::refuse(Arrived& map, icd::Refusal why) {
  end(map, std::unexpected(std::move(why)));
}

void AcceptedMaps::end(Arrived& map, const icd::Checked<void>& outcome) {
  store_.discard(std::exchange(map.file, nullptr));
  overtaken_.end(map.upload);
  map.done(outcome);
  for (const auto& each : std::exchange(waiting_, {})) take(each);
}

void AcceptedMaps::restore(spool::Spool::Kept kept) {
  store_.read_trouble();
  for (spool::Spool::KeptMap& each : kept) restore(std::move(each));
}

void AcceptedMaps::restore(spool::Spool::KeptMap kept) {
  const std::uint64_t number = kept.number;
  icd::MapUpdate update = std::move(kept.map);
  const bool again = store_.restored(number);
  const icd::Stamp stamp = update.header().stamp.value_or(loop_.stamp_now());
  counts_.accepted(traffic_of(update), update.data.bytes.size(), time_of(loop_, stamp));
  if (again) {
    store_.forget(queue_.put_back(waiting_again(number, std::move(update), kept.bounds, kept.ends)));
  } else {
    tell_clouds(update);
    queue_.restore(number, std::move(update), loop_.now(), kept.bounds, rule_after(kept.ends));
  }
  compare();
  queued_();
}

void AcceptedMaps::tell_clouds(const icd::MapUpdate& update) {
  const queues::Clouds clouds = queue_.clouds_of(queues::Sender::of(update));
  if (clouds != queues::Clouds::Auto) counts_.clouds_are(traffic_of(update), clouds);
}

/// It must not follow a newer map that contains it.
void AcceptedMaps::send_again(icd::MapUpdate update, std::function<bool(bool kept)> done,
                              const std::optional<icd::GridBounds>& bounds, int faults) {
  queues::QueuedMap back = waiting_again(store_.next_again(), update, bounds, {.faults = faults});
  auto absorbed = queue_.absorb(back);
  if (!absorbed) absorbed = prepared_.absorb(back);
  if (absorbed) {
    store_.forget(*std::move(absorbed));
    done(true);
    return;
  }
  update.header().stamp = loop_.stamp_now();
  back.map.data = {};  // so that the writer frees it chunk by chunk
  store_.store(
      std::move(update), nullptr, 0, /*again=*/true,
      [this, back = std::move(back), faults, done = std::move(done)](MapStore::Stored& stored) {
        if (stored.map && faults > 0) store_.remember(stored.number, {.faults = faults});
        stored_again(stored, back, done);
      },
      bounds);
}

void AcceptedMaps::stored_again(MapStore::Stored& stored, queues::QueuedMap back,
                                const std::function<bool(bool kept)>& done) {
  const bool is_wanted = done(stored.map.has_value());
  if (!stored.map) {
    return host::log(host::Level::Error, "cannot send a rejected map again",
                     {{"why", stored.map.error().sentence}});
  }
  back.map = std::move(*stored.map);
  back.updates = {stored.number};
  back.accepted = loop_.now();
  if (!is_wanted) return store_.forget({&stored.number, 1});
  if (auto absorbed = prepared_.absorb(back)) {
    absorbed->numbers.push_back(stored.number);
    return store_.forget(*std::move(absorbed));
  }
  store_.must_check(stored.number);  // perhaps rejected by an earlier process
  store_.forget(queue_.put_back(std::move(back)));
  queued_();
}

queues::QueuedMap AcceptedMaps::waiting_again(std::uint64_t number, icd::MapUpdate update,
                                              const std::optional<icd::GridBounds>& bounds,
                                              const Ends& ends) const {
  const icd::Stamp stamp = update.header().stamp.value_or(0);
  return {.map = std::move(update),
          .accepted = loop_.now(),
          .updates = {number},
          .packing = std::max(queues::PackingRule::Alone, rule_after(ends)),
          .bounds = bounds,
          .again = stamp};
}

/// One pair at a time, to save memory. Both stay queued and may be sent.
void AcceptedMaps::compare() {
  if (comparing_ || stopping_) return;
  auto next = queue_.to_compare();
  if (!next) return;
  struct Comparison {
    queues::Successive two;
    bool has_all = false;
  };
  const auto it = std::make_shared<Comparison>(Comparison{*std::move(next)});
  workers_.submit(
      loop::Urgency::OnTheWay,
      [it] { it->has_all = pack::has_all_points(it->two.newer, it->two.older, it->two.point_step); },
      [this, it] { compared(it->two, it->has_all); });
  comparing_ = true;
}

void AcceptedMaps::compared(const queues::Successive& two, bool has_all) {
  comparing_ = false;
  const Traffic traffic{Kind::Cloud, icd::text_of(two.sender.name)};
  if (has_all) {
    const auto replaced = queue_.replace(two);
    counts_.replaced(traffic, replaced.size());
    store_.forget(replaced);
  } else {
    queue_.keep_both(two);
  }
  counts_.clouds_are(traffic, has_all ? queues::Clouds::Whole : queues::Clouds::Parts);
  compare();
}

}  // namespace adit::forward
