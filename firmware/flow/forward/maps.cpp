#include "forward/maps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/read.hpp"
#include "codec/write.hpp"
#include "dispatch/verdicts.hpp"
#include "forward/channel.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "loop/guard.hpp"
#include "pace/delivery.hpp"
#include "pack/has_all_points.hpp"

namespace adit::forward {
namespace {

using dispatch::MappingVerdict;
using queues::MapEvent;
using queues::MapState;

/// A map after whose packing processes ended. Alone, because a fault counts against all maps in one message.
queues::PackingRule rule_after(const spool::Spool::EndCounts& ends) {
  using enum queues::PackingRule;
  constexpr int kMost = spool::Spool::EndCounts::kMost;
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
void crop(icd::OccupancyGrid& grid, const pack::Tile& tile) {
  const auto column = static_cast<std::int64_t>(tile.column), row = static_cast<std::int64_t>(tile.row);
  if (column > 0 || row > 0) grid.origin = queues::corner_at(grid, column, row).value_or(grid.origin);
  grid.width = static_cast<std::uint32_t>(tile.width);
  grid.height = static_cast<std::uint32_t>(tile.height);
}

/// The damaged maps among the `unread` ones in `waiting`.
std::vector<MapStore::DamagedMap> damaged_in(const queues::QueuedMap& waiting,
                                             const std::vector<std::uint64_t>& unread) {
  std::vector<MapStore::DamagedMap> damaged;
  const auto look_at = [&](const queues::QueuedMap& one) {
    if (std::ranges::find(unread, one.updates.back()) == unread.end()) return;
    if (auto checked = codec::check_data(one.map); !checked)
      damaged.push_back({one.updates.back(), std::move(checked.error().sentence)});
  };
  if (waiting.parts.empty()) look_at(waiting);
  for (const queues::QueuedMap& part : waiting.parts) look_at(part);
  return damaged;
}

/// How often a map in flight is checked.
constexpr std::chrono::milliseconds kLookAtSending{10}, kLookAtConnecting{100};
/// Servers may close an idle request.
constexpr std::chrono::seconds kLongestHeldBack{2};
/// Some servers answer this with a page to a body above their limit.
constexpr int kBadRequest = static_cast<int>(icd::Status::BadRequest);

/// Bytes between two maps.
std::size_t slot_of(const settings::CommandPost& post) {
  const double bytes = static_cast<double>(pace::map_bytes_per_second(post.budget_mbit)) / post.rates.map_hz;
  return static_cast<std::size_t>(std::max(bytes, 1.0));
}

queues::Sender sender_of(const Traffic& traffic) {
  return {icd::RobotName::parse(traffic.robot), traffic.kind == TrafficKind::Grid};
}

/// For queues::Blame.
std::string blame_key(const icd::MapUpdate& map) {
  return (map.is_grid() ? "grid " : "cloud ") + icd::text_of(map.name);
}

/// A connection for the next map is made so long before it may start, and the end of the one before is looked
/// for so often from then on: the link is idle in between.
constexpr std::chrono::milliseconds kGetReady{50}, kLookForEnd{2};

/// A Command Post may read both at the same time, and then check the small one before a large one that
/// arrived first. Its stamp would run backward. A slow one reads so many bytes of a map's data in a second.
constexpr double kReads = 20e6;

loop::Duration reading_takes(const icd::MapUpdate& map) {
  return std::chrono::duration_cast<loop::Duration>(
      std::chrono::duration<double>(static_cast<double>(map.data.raw_size) / kReads));
}

}  // namespace

Maps::Maps(loop::Loop& loop, uplink::Servers& servers, loop::Workers& workers, loop::Writer& writer,
           spool::Spool& spool, const settings::Settings& settings, std::optional<icd::BearerToken> token,
           TrafficCounts& counts, RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
           std::function<void(icd::MapUpdate)> taken)
    : loop_(loop),
      workers_(workers),
      settings_(settings),
      counts_(counts),
      rejected_(rejected),
      journal_(journal),
      taken_(std::move(taken)),
      channel_(loop, servers, "mapping",
               access_to_mapping(settings.command_post, std::move(token),
                                 pace::map_bytes_per_second(settings.command_post.budget_mbit)),
               [this] { pump(); }),
      pace_(icd::Uri::MapUpdate, settings.command_post.rates.map_hz, random, journal),
      wake_(loop.timer([this] { pump(); })),
      queue_(settings.queues.merge_bytes),
      store_(writer, spool),
      slot_(pace::map_bytes_per_second(settings.command_post.budget_mbit)),
      packing_(loop, [this] { store_.record_overrun(); }) {
  apply_settings();
  queue_.canvases().lead_to(channel_.address());
}

void Maps::apply_settings() {
  queue_.set_slot_bytes(slot_of(settings_.command_post));
  queue_.merge_at_most(settings_.queues.merge_bytes);
  queue_.set_cloud_modes(settings::map_by_robot(settings_.robots, &settings::Robot::clouds));
  queue_.set_precisions(settings::map_by_robot(settings_.robots, &settings::Robot::precision));
}

void Maps::on_settings_changed() {
  apply_settings();
  slot_.allow(pace::map_bytes_per_second(settings_.command_post.budget_mbit));
  pace_.allow(settings_.command_post.rates.map_hz, loop_.now());
  pump();
}

void Maps::on_endpoint_changed(std::optional<icd::BearerToken> token) {
  const settings::CommandPost& post = settings_.command_post;
  channel_.lead_to(access_to_mapping(post, std::move(token), pace::map_bytes_per_second(post.budget_mbit)));
  channel_.give_up();
  pump();
}

/// After a power cut the areas of earlier grids are unknown. The record that begins grids shows it.
void Maps::restore(const journal::HandoverState& carried, bool ran_before) {
  queues::Canvases::PostedAreas posted = carried.grids().value_or(queues::Canvases::PostedAreas{});
  if (!carried.grids()) {
    const auto everywhere = queues::Extent::infinite();
    const auto told =
        ran_before ? journal_.record_grid(queues::Canvases::kAnyName, everywhere) : journal_.begin_grids();
    if (ran_before || !told) posted[queues::Canvases::kAnyName] = everywhere;
    are_grids_told_ = told.has_value();
  }
  queue_.canvases().restore(std::move(posted));
  pace_.restore(carried, loop_.now());
  for (const auto& [robot, heard] : carried.heard_by_robot()) {
    for (const TrafficKind kind : {TrafficKind::Grid, TrafficKind::Cloud})
      behind_[{kind, robot}] = heard.behind.at(static_cast<std::size_t>(kind));
  }
}

/// Journals posted areas, so that later processes know the cells that were never sent. False: not journaled,
/// do not accept the grid. If the start could not read the journal, it is left for the next process.
bool Maps::record_area(const icd::MapUpdate& update) {
  if (!update.is_grid()) return true;
  if (!are_grids_told_) {
    const auto everywhere = queues::Extent::infinite();
    are_grids_told_ = journal_.record_grid(queues::Canvases::kAnyName, everywhere).has_value();
    if (!are_grids_told_) return false;
  }
  const auto grows = queue_.canvases().grows(update);
  if (!grows) return true;
  if (!journal_.record_grid(grows->first, grows->second)) return false;
  queue_.canvases().on_grown(*grows);
  return true;
}

/// A full queue accepts replacing maps. If it is full by number alone, it accepts merging maps.
bool Maps::has_room_for(const icd::MapUpdate& update, bool replaces) const {
  const std::size_t waiting = queue_.bytes() + store_.bytes();
  const std::size_t count = queue_.count() + store_.count();
  if (!replaces && count >= kMostMaps && (count >= kMostWithJoined || !queue_.can_join_last(update)))
    return false;
  return replaces || waiting == 0 || waiting + update.data.bytes.size() <= settings_.queues.map_bytes;
}

void Maps::accept(const std::shared_ptr<ReceivedMap>& map) {
  if (overtaken_.must_wait(map->upload)) return waiting_.push_back(map);
  icd::MapUpdate& update = map->update;
  const bool is_whole = queue_.clouds_of(queues::Sender::from_map(update)) == queues::Clouds::Whole;
  const auto newer = update.is_grid() || is_whole ? overtaken_.find_newer(update, map->upload)
                                                  : std::vector<icd::GridBounds>();
  const bool replaces = newer.empty() && queue_.replaces_any(update);
  if (!has_room_for(update, replaces)) {
    counts_.no_room(traffic_of(update), loop_.wall_now());
    return refuse(*map, {icd::Status::TooManyRequests,
                         icd::sentence("the queue is full: ", queue_.count() + store_.count(), " maps, ",
                                       icd::size_text(queue_.bytes() + store_.bytes()),
                                       "; this map was not accepted, send it again later")});
  }
  if (!record_area(update)) return refuse(*map, storage_refusal());
  overtaken_.begin(map->upload, !newer.empty());
  if (!newer.empty()) return store_uncovered(map, newer);
  // Newer grids and whole clouds need room beside the old one.
  const std::uint64_t of_its_own = update.is_grid() || is_whole ? update.data.bytes.size() : 0;
  const std::uint64_t spare =
      replaces ? 0 : std::max<std::uint64_t>(queue_.largest_replaceable(), of_its_own);
  store_.store(std::move(update), std::move(map->file), spare, /*again=*/false,
               [this, map](MapStore::StoredMap& stored) { this->on_stored(stored, *map); });
}

/// Queued now; the sender may know.
void Maps::on_stored(MapStore::StoredMap& stored, ReceivedMap& map) {
  if (stored.has_no_valid_point) {
    counts_.no_valid_point(traffic_of(*stored.map), map.upload.bytes, loop_.wall_now());
    store_.forget({&stored.number, 1});
    return end(map, {});
  }
  if (!stored.map) return refuse(map, std::move(stored.map.error()));
  map.update.name = stored.map->name;
  map.update.msg = stored.map->msg;
  overtaken_.record(map.update, map.upload);
  queue(stored);
  accept(map);
}

void Maps::queue(MapStore::StoredMap& stored) {
  const Traffic traffic = traffic_of(*stored.map);
  set_cloud_kind(*stored.map);
  const auto replaced = queue_.add(stored.number, std::move(*stored.map), loop_.now());
  counts_.count_replaced(traffic, replaced.numbers.size());
  store_.forget(replaced);
}

void Maps::store_uncovered(const std::shared_ptr<ReceivedMap>& map, std::span<const icd::GridBounds> newer) {
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&map->update.msg);
  if (grid != nullptr) map->tiles = tiles_outside(*grid, newer);
  if (map->tiles.empty()) {  // the Command Post has newer data, or will have it
    counts_.count_replaced(traffic_of(map->update), 1);
    return accept(*map);
  }
  map->cut = std::unexpected(storage_refusal());
  workers_.submit(
      loop::Urgency::OnTheWay,
      [map, width = grid->width] { map->cut = pack::cut(map->update.data, width, map->tiles); },
      [this, map] {
        if (!map->cut) return refuse(*map, std::move(map->cut.error()));
        map->update.data = {};
        store_next_tile(map);
      });
}

void Maps::store_next_tile(const std::shared_ptr<ReceivedMap>& map) {
  icd::MapUpdate part = map->update;
  crop(std::get<icd::OccupancyGrid>(part.msg), map->tiles.back());
  part.data = std::move(map->tiles.back().data);
  map->tiles.pop_back();
  store_.store(std::move(part), nullptr, /*spare=*/0, /*again=*/false,
               [this, map](MapStore::StoredMap& stored) {
                 if (!stored.map) {
                   for (const MapStore::StoredMap& part : map->parts) store_.forget({&part.number, 1});
                   return refuse(*map, std::move(stored.map.error()));
                 }
                 map->parts.push_back(std::move(stored));
                 if (!map->tiles.empty()) return store_next_tile(map);
                 for (MapStore::StoredMap& part : map->parts) {
                   overtaken_.record(*part.map, map->upload);
                   queue(part);
                 }
                 accept(*map);
               });
}

void Maps::accept(ReceivedMap& map) {
  counts_.count_accepted(traffic_of(map.update), map.upload.bytes, loop_.wall_now());
  end(map, {});
  compare();
  pump();
}

void Maps::end(ReceivedMap& map, const icd::Checked<void>& outcome) {
  store_.discard(std::exchange(map.file, nullptr));
  overtaken_.end(map.upload);
  map.done(outcome);
  for (const auto& each : std::exchange(waiting_, {})) accept(each);
}

void Maps::restore(spool::Spool::KeptMaps kept) {
  const auto at_fault = std::ranges::stable_partition(kept, [](const spool::Spool::KeptMap& each) {
    return each.ends.faults < spool::Spool::EndCounts::kMost;
  });
  for (spool::Spool::KeptMap& each : at_fault) put_aside(std::move(each));
  kept.erase(at_fault.begin(), at_fault.end());
  store_.read_trouble();
  for (spool::Spool::KeptMap& each : kept) restore(std::move(each));
  behind_.clear();
}

/// Its file stays until the rejected messages have one.
void Maps::put_aside(spool::Spool::KeptMap kept) {
  store_.adopt(kept.number);
  const Traffic traffic = traffic_of(kept.map);
  const std::size_t bytes = kept.map.data.bytes.size();
  const std::string why =
      icd::sentence("the service ended ", kept.ends.faults, " times by a fault while it packed this map");
  counts_.count_accepted(traffic, bytes, time_of(loop_, kept.map.header().stamp.value_or(loop_.stamp_now())));
  counts_.count_undelivered(traffic, DeliveryFailure::Failed, 0, why);
  rejected_.add(std::move(kept.map), 0, why, bytes,
                {.release = [this, number = kept.number] { store_.forget({&number, 1}); }}, kept.bounds,
                kept.ends.faults);
}

void Maps::restore(spool::Spool::KeptMap kept) {
  const std::uint64_t number = kept.number;
  icd::MapUpdate update = std::move(kept.map);
  const bool again = store_.adopt(number);
  const icd::Stamp stamp = update.header().stamp.value_or(loop_.stamp_now());
  counts_.count_accepted(traffic_of(update), update.data.bytes.size(), time_of(loop_, stamp));
  if (again) {
    store_.forget(queue_.put_back(requeued_map(number, std::move(update), kept.bounds, kept.ends)));
  } else {
    set_cloud_kind(update);
    // The sender's first map may stand for older ones, which it replaced.
    const auto behind = behind_.extract(traffic_of(update));
    const icd::Stamp since = behind ? std::fmin(stamp, behind.mapped()) : stamp;
    queue_.restore(number, std::move(update), instant_of(loop_, since), kept.bounds, rule_after(kept.ends));
  }
  compare();
  pump();
}

void Maps::set_cloud_kind(const icd::MapUpdate& update) {
  const queues::Clouds clouds = queue_.clouds_of(queues::Sender::from_map(update));
  if (clouds != queues::Clouds::Auto) counts_.set_cloud_kind(traffic_of(update), clouds);
}

/// It must not follow a newer map that contains it.
void Maps::resend(icd::MapUpdate update, std::function<bool(bool kept)> done,
                  const std::optional<icd::GridBounds>& bounds, int faults) {
  queues::QueuedMap back = requeued_map(store_.next_resend_number(), update, bounds, {.faults = faults});
  auto absorbed = queue_.absorb(back);
  if (!absorbed) absorbed = absorb(back);
  if (absorbed) {
    store_.forget(*std::move(absorbed));
    done(true);
    return;
  }
  update.header().stamp = loop_.stamp_now();
  back.map.data = {};  // so that the writer frees it chunk by chunk
  store_.store(
      std::move(update), nullptr, 0, /*again=*/true,
      [this, back = std::move(back), faults, done = std::move(done)](MapStore::StoredMap& stored) {
        if (stored.map && faults > 0) store_.remember(stored.number, {.faults = faults});
        finish_storing(stored, back, done);
      },
      bounds);
}

void Maps::finish_storing(MapStore::StoredMap& stored, queues::QueuedMap back,
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
  if (auto absorbed = absorb(back)) {
    absorbed->numbers.push_back(stored.number);
    return store_.forget(*std::move(absorbed));
  }
  store_.mark_unchecked(stored.number);  // perhaps rejected by an earlier process
  store_.forget(queue_.put_back(std::move(back)));
  pump();
}

queues::QueuedMap Maps::requeued_map(std::uint64_t number, icd::MapUpdate update,
                                     const std::optional<icd::GridBounds>& bounds,
                                     const spool::Spool::EndCounts& ends) const {
  const icd::Stamp stamp = update.header().stamp.value_or(0);
  return {.map = std::move(update),
          .accepted = loop_.now(),
          .updates = {number},
          .packing = std::max(queues::PackingRule::Alone, rule_after(ends)),
          .bounds = bounds,
          .again = stamp};
}

/// One pair at a time, to save memory. Both stay queued and may be sent.
void Maps::compare() {
  if (is_comparing_ || stopping_) return;
  auto next = queue_.uncompared_clouds();
  if (!next) return;
  struct Comparison {
    queues::CloudPair two;
    bool has_all = false;
  };
  const auto it = std::make_shared<Comparison>(Comparison{*std::move(next)});
  workers_.submit(
      loop::Urgency::OnTheWay,
      [it] { it->has_all = pack::has_all_points(it->two.newer, it->two.older, it->two.point_step); },
      [this, it] { on_compared(it->two, it->has_all); });
  is_comparing_ = true;
}

void Maps::on_compared(const queues::CloudPair& two, bool has_all) {
  is_comparing_ = false;
  const Traffic traffic{TrafficKind::Cloud, icd::text_of(two.sender.name)};
  if (has_all) {
    const auto replaced = queue_.replace(two);
    counts_.count_replaced(traffic, replaced.size());
    store_.forget(replaced);
  } else {
    queue_.keep_both(two);
  }
  counts_.set_cloud_kind(traffic, has_all ? queues::Clouds::Whole : queues::Clouds::Parts);
  compare();
}

std::vector<const Maps::PreparedMap*> Maps::prepared_of(const Traffic& traffic) const {
  std::vector<const PreparedMap*> all;
  for (const PreparedMap* each : {first_.get(), following_.get()}) {
    if (each != nullptr && traffic_of(each->waiting.map) == traffic) all.push_back(each);
  }
  return all;
}

/// A worker that packs the map reads no bounds.
std::optional<queues::ReplacedMaps> Maps::absorb(const queues::QueuedMap& back) {
  for (const Place& place : {first_, following_}) {
    if (!place) continue;
    if (auto replaced = queues::absorb(place->waiting, back)) return replaced;
  }
  return {};
}

void Maps::prepare(bool follows) {
  slot_.set_link_rate(channel_.delivers());
  queue_.set_message_points(slot_.points_for(pace_.spacing()));
  auto waiting = queue_.pop(loop_.now());
  if (!waiting) return;
  Place& place = follows ? following_ : first_;
  place = std::make_shared<PreparedMap>(PreparedMap{.waiting = std::move(*waiting)});
  pack(place);
}

void Maps::pack(const Place& prepared) {
  step(prepared, MapEvent::Chosen);
  icd::Header& header = prepared->waiting.map.header();
  header.stamp = pace_.next_stamp(header.stamp.value_or(loop_.stamp_now()));
  pace_.keep_stamp(*header.stamp);
  const loop::Instant began = loop_.now();
  const Packing packing{settings_.command_post.arrange_clouds, slot_.effort_input(pace_.spacing())};
  const auto unread = store_.begin_work(prepared->waiting);
  workers_.submit(
      loop::Urgency::OnTheWay,
      [prepared, packing, unread, &loop = loop_, starts = packing_.begin(), file = store_.work_file()] {
        const loop::FaultCounter faults(file.c_str());
        const loop::Instant begins = loop.now();
        starts();
        prepared->damaged = damaged_in(prepared->waiting, unread);
        if (!prepared->damaged.empty()) return;
        prepared->packed = pack_map(prepared->waiting, packing);
        prepared->packing_took = loop.now() - begins;
        if (!prepared->packed.body.empty() || prepared->packed.has_no_valid_point) return;
        std::vector<std::uint64_t> numbers;
        queues::add_own_numbers(numbers, prepared->waiting);
        prepared->damaged = damaged_in(prepared->waiting, numbers);
      },
      [this, began, prepared, unread] {
        is_packing_ = false;
        packing_.end();
        const bool is_good = prepared->damaged.empty();
        store_.end_work(is_good, unread);
        if (is_good) slot_.on_packing_done(loop_.now() - began);
        on_work_done(prepared);
        pump();
      },
      [this, prepared] { on_work_failed(prepared); });
  is_packing_ = true;
}

void Maps::on_work_done(const Place& prepared) {
  if (prepared->damaged.empty()) {
    const PackedMap& packed = prepared->packed;
    slot_.on_work_done(prepared->packing_took, packed.expected);
    slot_.on_packed(packed.points_size, packed.full_size, packed.precision);
  }
  if (prepared->state != MapState::Packing) return;  // recalled
  if (!prepared->damaged.empty()) return step(prepared, MapEvent::Damaged);
  queues::QueuedMap& waiting = prepared->waiting;
  if (prepared->packed.has_no_valid_point) {
    if (queues::next_piece(waiting)) return step(prepared, MapEvent::SkippedPiece);
    counts_.count_replaced(traffic_of(waiting.map), waiting.updates.size());
    return step(prepared, MapEvent::SkippedLast);
  }
  if (prepared->packed.drawn) queue_.canvases().lay(waiting.map.name, *prepared->packed.drawn);
  prepared->packed.drawn.reset();
  if (prepared->packed.body.empty()) {
    host::log(host::Level::Warning, "cannot join grids: their data is damaged");
    return step(prepared, MapEvent::NotStitched);
  }
  if (prepared->packed.stitched.raw_size > 0) waiting.map.data = std::move(prepared->packed.stitched);
  step(prepared, MapEvent::Packed);
}

void Maps::on_work_failed(const Place& prepared) {
  is_packing_ = false;
  packing_.end();
  store_.end_work(false, {});
  prepared->packed = {};
  if (prepared->state == MapState::Packing) {
    counts_.count_undelivered(traffic_of(prepared->waiting.map), DeliveryFailure::Failed, 0,
                              "it could not be compressed");
    step(prepared, MapEvent::NotPacked);
  }
  pace_.on_failed(loop_.now());
  wake_.call_at(pace_.ready());
}

/// A map that returns to the queue goes ahead of its follower, which returns first.
void Maps::step(Place map, MapEvent event) {
  using enum queues::MapAction;
  const queues::MapTransition& row = queues::transition(map->state, event);
  map->state = row.to;
  if (row.action == Nothing) return;
  if (row.to == MapState::Queued && map == first_) recall(following_);
  if (map == first_) {
    first_ = std::exchange(following_, nullptr);
  } else {
    following_.reset();
  }
  switch (row.action) {
    case Nothing:
    case Reject:  // give_up() has done it
      return;
    case PutBack:  // a copy: a worker may read it
      return store_.forget(queue_.put_back(map->waiting));
    case PutBackApart:
      return queue_.put_back_single(map->waiting);
    case PutBackSmaller:
      return put_back_smaller(*map);
    case Forget:
      return store_.forget(map->waiting.updates);
    case SetAside:
      return set_aside(*map);
  }
}

/// Except one in flight.
void Maps::recall(const Place& map) {
  if (map && map->state != MapState::InFlight) step(map, MapEvent::Recalled);
}

/// A single cloud or grid goes on in pieces within the limit.
void Maps::put_back_smaller(PreparedMap& map) {
  if (!map.waiting.parts.empty()) return queue_.put_back_halves(map.waiting);
  const std::size_t size = map.packed.body.size();
  std::size_t pieces = 2;
  while (!slot_.fits(size / pieces)) ++pieces;
  queues::shrink(map.waiting, pieces);
  store_.forget(queue_.put_back(map.waiting));
}

/// Records the damaged maps as failed and renames their files. The other parts are queued again, each alone.
void Maps::set_aside(const PreparedMap& map) {
  queues::QueuedMap rest = map.waiting;
  std::vector<std::uint64_t> gone;
  gone.reserve(map.damaged.size());
  for (const MapStore::DamagedMap& each : map.damaged) gone.push_back(each.number);
  const auto is_gone = [&](std::uint64_t number) { return std::ranges::find(gone, number) != gone.end(); };
  std::erase_if(rest.parts, [&](const queues::QueuedMap& part) { return is_gone(part.updates.back()); });
  std::erase_if(rest.updates, is_gone);
  store_.set_aside(map.damaged);
  if (!rest.parts.empty()) queue_.put_back_single(std::move(rest));
  for (const MapStore::DamagedMap& each : map.damaged) {
    counts_.count_undelivered(traffic_of(map.waiting.map), DeliveryFailure::Failed, 0,
                              "its stored copy is damaged: " + each.why);
  }
  store_.forget(gone);
}

void Maps::repack() {
  recall(following_);
  recall(first_);
  queue_.restart_pieces();
  for (const Place& place : {first_, following_}) {
    if (place && std::exchange(place->waiting.piece, {}).size > 0) place->begins_again = true;
  }
}

void Maps::pump() noexcept {
  if (!stopping_ && channel_.turns()) {
    pace_.on_link_up();
    blame_ = {};
    ahead_ = {};
    slot_.forget_sizes();
    queue_.canvases().lead_to(channel_.address());
    repack();
  }
  if (stopping_ || is_packing_ || !channel_.has_token()) return;
  advance();
}

void Maps::advance() {
  const loop::Instant now = loop_.now();
  const bool follows = channel_.busy();
  const Place& next = follows ? following_ : first_;
  if (next && next->state == MapState::InFlight) return;
  if (next && must_split(*next)) {
    step(next, MapEvent::TooLarge);
    return advance();
  }
  if (next && follows) return pipeline_map(now);
  if (next) {
    if (now < start_time()) return wake_.call_at(start_time());
    if (channel_.claim_turn()) send(next);
    return;
  }
  if (queue_.count() == 0) return;
  const loop::Instant begin = packing_time(now);
  if (now >= begin) return prepare(follows);
  wake_.call_at(begin);
}

/// Of the next map, whose last byte is held back, except to a serial server.
loop::Instant Maps::start_time() const {
  const pace::Span earliest = pace_.earliest();
  return std::max(earliest.first,
                  earliest.last - (channel_.is_serial() ? std::chrono::seconds{} : kLongestHeldBack));
}

/// Late, so that newer data replaces queued maps, but in time for its start or the end of the map in flight.
/// No packing while the link is down.
loop::Instant Maps::packing_time(loop::Instant now) const {
  loop::Instant free = now;
  if (channel_.busy() && !first_->arrived) {
    if (!channel_.is_connected()) return now + kLookAtConnecting;
    const std::size_t size = first_->packed.body.size();
    free += slot_.transfer(size - std::min(size, channel_.sent_bytes()));
  }
  const loop::Instant begin = std::max(start_time(), free) - slot_.lead();
  return begin <= now ? begin : std::max(begin, now + kLookAtSending);
}

/// Once the one that is under way has arrived; it is looked for when the next may start, and not before.
void Maps::pipeline_map(loop::Instant now) {
  if (!can_pipeline(now)) return;
  PreparedMap& first = *first_;
  const std::size_t size = first.packed.body.size(), left = size - std::min(size, channel_.sent_bytes());
  if (!first.arrived && left > 0)
    return wake_.call_at(now + std::max<loop::Duration>(slot_.transfer(left) / 2, kLookAtSending));
  if (now < start_time() - kGetReady) return wake_.call_at(start_time() - kGetReady);
  channel_.preconnect();
  const auto arrived = first.arrived ? std::nullopt : channel_.has_arrived();
  if (arrived) {
    first.arrived = arrived->last;
    pace_.on_departed(*arrived);
  }
  loop::Instant begin = start_time();
  if (first.arrived) begin = std::max(begin, *first.arrived + reading_takes(first.waiting.map));
  if (first.arrived && channel_.can_go_ahead() && now >= begin) return send(following_);
  wake_.call_at(std::max(begin, now + kLookForEnd));
}

/// If not, the answer to the one that is under way is awaited.
bool Maps::can_pipeline(loop::Instant now) const {
  const PreparedMap& first = *first_;
  const queues::Pipelining::PreviousMap before{
      .map = first.waiting, .arrived = first.arrived.value_or(now), .went_ahead = first.went_ahead};
  return first.state == MapState::InFlight && !channel_.is_serial() && pace_.can_pipeline(now) &&
         ahead_.can_send(following_->waiting, before, now);
}

void Maps::send(const Place& prepared) {
  const bool ahead = channel_.busy();
  prepared->last_byte_not_before = pace_.earliest().last;
  pace_.on_sent(loop_.now(), ahead);
  channel_.send(
      icd::Uri::MapUpdate, codec::kCbor, prepared->packed.body,
      [this, prepared](const uplink::Outcome& outcome) { on_answered(prepared, outcome); },
      prepared->last_byte_not_before);
  step(prepared, MapEvent::Sent);
  prepared->went_ahead = ahead;
  if (ahead) first_->was_followed = true;
  prepared->arrived.reset();
  wake_.call_at(loop_.now());  // for the following map
}

void Maps::on_answered(const Place& sent, const uplink::Outcome& outcome) {
  classify(sent, outcome);
  pump();
}

void Maps::classify(const Place& sent, const uplink::Outcome& outcome) {
  if (const auto* answer = std::get_if<uplink::Answered>(&outcome)) return on_verdict(sent, *answer);
  pace_.on_failed(outcome, loop_.now());
  const std::string sentence = sentence_of(outcome);
  if (std::holds_alternative<uplink::InDoubt>(outcome) && is_cut_by_size(*sent))
    return send_smaller(sent, sent->waiting.cuts.at, 0, sentence);
  counts_.count_undelivered(traffic_of(sent->waiting.map), DeliveryFailure::Failed, 0, sentence);
  retry(sent);
}

void Maps::on_accepted(const Place& sent, const uplink::Answered& answered) {
  pace_.on_answered(answered.sent, loop_.now());
  slot_.on_sent(sent->packed.body.size(), answered.sent, sent->last_byte_not_before);
  slot_.on_passed(sent->packed.body.size());
  icd::MapUpdate& map = sent->waiting.map;
  if (sent->begins_again) {
    counts_.count_forwarded(traffic_of(map), 0, sent->packed.body.size(), answered.status, loop_.wall_now());
    return retry(sent);
  }
  ahead_.on_accepted(sent->went_ahead);
  blame_.on_passed(blame_key(map), loop_.now());
  queue_.on_passed(queues::Sender::from_map(map));
  queue_.charge(queues::Sender::from_map(map), sent->packed.body.size());
  if (queues::next_piece(sent->waiting)) {
    counts_.count_forwarded(traffic_of(map), 0, sent->packed.body.size(), answered.status, loop_.wall_now());
    return step(sent, MapEvent::AcceptedPiece);
  }
  const std::size_t updates = sent->waiting.updates.size();
  if (sent->waiting.again) map.header().stamp = sent->waiting.again;
  // First: the writer works in order.
  for (const icd::MapUpdate* const said : queues::delivered_maps(sent->waiting))
    rejected_.mark_contained(*said);
  step(sent, MapEvent::Accepted);
  counts_.count_forwarded(traffic_of(map), updates, sent->packed.body.size(), answered.status,
                          loop_.wall_now());
  if (!map.is_grid()) counts_.rounded_to(traffic_of(map), sent->packed.precision);
  taken_(std::move(map));
}

void Maps::on_verdict(const Place& sent, const uplink::Answered& answered) {
  const loop::Instant now = loop_.now();
  const Traffic traffic = traffic_of(sent->waiting.map);
  const std::string sentence = sentence_of(answered, sent->packed.body.size());
  switch (dispatch::mapping_verdict(answered.status, dispatch::body_of(answered.body))) {
    case MappingVerdict::Taken:
      return on_accepted(sent, answered);
    case MappingVerdict::Throttled:
      pace_.on_throttled(now, answered.retry_after);
      counts_.count_undelivered(traffic, DeliveryFailure::Throttled, answered.status, sentence);
      return retry(sent);
    case MappingVerdict::Refused:
      pace_.on_answered(answered.sent, now);
      if (can_be_overtaken(*sent)) {
        ++sent->waiting.trial.failures;
        counts_.count_undelivered(traffic, DeliveryFailure::Failed, answered.status, sentence);
        return retry(sent);
      }
      return give_up(sent, answered.status, sentence);
    case MappingVerdict::TooLarge:
      pace_.on_answered(answered.sent, now);
      return on_too_large(sent, answered, sentence);
    case MappingVerdict::Suspect:
      pace_.on_lost(now);
      if (answered.status == kBadRequest && is_cut_by_size(*sent))
        return send_smaller(sent, sent->waiting.cuts.at, answered.status, sentence);
      if (blame_.on_failed(blame_key(sent->waiting.map), sent->waiting.trial, now) ==
          queues::Blame::Decision::Reject)
        return give_up(sent, answered.status,
                       sentence + " (other maps were delivered, this map failed repeatedly)");
      counts_.count_undelivered(traffic, DeliveryFailure::Failed, answered.status, sentence);
      return retry(sent);
    case MappingVerdict::Failing:
      pace_.on_failed(answered, now);
      counts_.count_undelivered(traffic, DeliveryFailure::Failed, answered.status, sentence);
      return retry(sent);
  }
}

/// Its sender pays for the upload. If a proxy may have answered, it must fail as often as a map that fails
/// alone.
void Maps::on_too_large(const Place& sent, const uplink::Answered& answered, const std::string& sentence) {
  queues::QueuedMap& waiting = sent->waiting;
  const queues::Sender sender = queues::Sender::from_map(waiting.map);
  queue_.charge(sender, sent->packed.body.size());
  const std::size_t size = sent->packed.body.size();
  if (queues::can_split(waiting, size)) return send_smaller(sent, size, answered.status, sentence);
  slot_.on_too_large(size);
  const bool is_page = dispatch::body_of(answered.body) == dispatch::Body::Other;
  if (!is_page) return give_up(sent, answered.status, sentence);
  const auto next = blame_.on_failed(blame_key(waiting.map), waiting.trial, loop_.now());
  queue_.on_too_large(sender, waiting.trial);
  if (next == queues::Blame::Decision::Reject) return give_up(sent, answered.status, sentence);
  counts_.count_undelivered(traffic_of(waiting.map), DeliveryFailure::Failed, answered.status, sentence);
  retry(sent);
}

/// The endpoint would not accept it.
bool Maps::must_split(const PreparedMap& prepared) const {
  const std::size_t size = prepared.packed.body.size();
  return !slot_.fits(size) && queues::can_split(prepared.waiting, size);
}

/// Of two maps in flight the bytes that had left are not known. A map that cannot be split is retried,
/// because a fault of the link is never a reason to reject it.
bool Maps::is_cut_by_size(PreparedMap& sent) {
  const std::size_t size = sent.packed.body.size();
  if (size < queues::Cuts::kLeastBody || !queues::can_split(sent.waiting, size)) return false;
  if (sent.went_ahead || channel_.busy()) return false;
  return sent.waiting.cuts.check(channel_.sent_bytes(), counts_.delivered_count());
}

/// A Command Post that reads slowly checks a small map that followed first: this one's stamp then ran
/// backward. It is sent once more alone, because a map that failed neither goes ahead nor is followed.
bool Maps::can_be_overtaken(const PreparedMap& sent) {
  return sent.was_followed && sent.waiting.trial.failures == 0;
}

/// A message that ended after so many bytes was too large.
void Maps::send_smaller(const Place& sent, std::size_t bytes, int status, const std::string& sentence) {
  counts_.count_undelivered(traffic_of(sent->waiting.map), DeliveryFailure::Failed, status,
                            sentence + "; it is sent in smaller messages");
  slot_.on_too_large(std::min(bytes, sent->packed.body.size()));
  ahead_.on_failed(false);
  step(sent, MapEvent::TooLarge);
}

void Maps::retry(const Place& sent) {
  ahead_.on_failed(sent->went_ahead || channel_.busy());
  step(sent, MapEvent::Failed);
}

/// Parts of a merged or stitched map are tried separately.
void Maps::give_up(const Place& sent, int status, const std::string& sentence) {
  ahead_.on_failed(false);
  queues::QueuedMap& waiting = sent->waiting;
  counts_.count_undelivered(traffic_of(waiting.map), DeliveryFailure::Refused, status, sentence);
  if (waiting.again) waiting.map.header().stamp = waiting.again;
  if (!waiting.parts.empty()) return step(sent, MapEvent::RejectedParts);
  rejected_.add(waiting.map, status, sentence, waiting.map.data.bytes.size(),
                {.release = [this, numbers = waiting.updates] { store_.forget(numbers); }}, waiting.bounds);
  step(sent, MapEvent::Rejected);
}

/// False if maps go to another Command Post, whose statuses Adit does not read.
bool Maps::is_heard_from() const {
  return channel_.address() == address_text(settings_.command_post.mapping);
}

void Maps::on_status() {
  if (!is_heard_from()) return;
  std::vector<const icd::MapUpdate*> under_way;
  for (const Place& place : {first_, following_}) {
    if (place) under_way.push_back(&place->waiting.map);
  }
  queue_.canvases().on_status(under_way);
}

void Maps::change_run(dispatch::NextMap next) {
  repack();
  queues::Canvases& canvases = queue_.canvases();
  if (next == dispatch::NextMap::Empty && is_heard_from()) return canvases.begin_run();
  if (next == dispatch::NextMap::Earlier) return canvases.resume_run();
  canvases.change_run();
}

void Maps::on_link_up() {
  pace_.on_link_up();
  channel_.retry_now();
  pump();
}

bool Maps::stop() {
  set_standby();
  return !channel_.busy();
}

std::size_t Maps::waiting(const Traffic& traffic) const {
  return queue_.count(sender_of(traffic)) + prepared_of(traffic).size();
}

std::optional<loop::Instant> Maps::oldest_acceptance(const Traffic& traffic) const {
  std::optional<loop::Instant> oldest = queue_.oldest(sender_of(traffic));
  for (const PreparedMap* prepared : prepared_of(traffic)) {
    oldest = std::min(oldest.value_or(prepared->waiting.accepted), prepared->waiting.accepted);
  }
  return oldest;
}

}  // namespace adit::forward
