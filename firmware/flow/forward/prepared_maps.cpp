#include "forward/prepared_maps.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "codec/read.hpp"
#include "host/log.hpp"
#include "loop/guard.hpp"
#include "pace/budget.hpp"

namespace adit::forward {
namespace {

using Seconds = std::chrono::duration<double>;

/// What shorter messages show of the link is little more than its delay.
constexpr std::size_t kTelling = 64u << 10;
/// So much at least, so that a link that was slow is found to be fast again.
constexpr double kLeast = 4.0 * kTelling;
/// What rounding makes of a cloud's bytes at each precision, as measured (tests/bench/README.md).
constexpr std::array<double, 3> kOfExact{1, 0.65, 0.5};
constexpr double kSmallest = 0.01;  // that packing is expected to make of a byte
constexpr std::chrono::milliseconds kHeldBack{20};
/// Of the limit, because clouds do not all pack alike.
constexpr double kOfLimit = 0.9;

}  // namespace

void Slot::allow(std::uint64_t most) {
  most_ = bytes_per_second_ = static_cast<double>(most);
}

/// A longer time counts at once. Of its excess over shorter ones, a third is left after eight of them.
void Slot::packing_took(loop::Duration took) {
  packing_takes_ = std::max(took, packing_takes_ - (packing_takes_ - took) / 8);
}

loop::Duration Slot::lead() const {
  return std::min<loop::Duration>(packing_takes_, kLongestLead);
}

void Slot::packed(std::size_t points, std::size_t bytes, queues::Precision precision) {
  if (points < kTelling) return;
  const double packed_to = static_cast<double>(bytes) / static_cast<double>(points);
  packed_to_ = std::clamp(packed_to / kOfExact.at(static_cast<std::size_t>(precision)), kSmallest, 1.0);
}

/// Bytes that were held back give only a lower limit of the speed.
void Slot::left(std::size_t bytes, const uplink::Sent& sent, loop::Instant last_byte_not_before) {
  if (bytes < kTelling) return;
  const double took = std::max(Seconds(sent.last - sent.first).count(), 1e-6);
  const double seen = std::min(static_cast<double>(bytes) / took, most_);
  const bool was_held_back = sent.last <= last_byte_not_before + kHeldBack;
  bytes_per_second_ = was_held_back ? std::max(seen, bytes_per_second_) : seen;
}

/// Small maps are ignored, because their times vary, and many grids take far less time than expected. After
/// each map that was not compressed, the box counts as a little less slow, so that Adit forgets a stall.
void Slot::worker_took(loop::Duration took, double expected) {
  constexpr double kLeastExpected = 0.5e-3, kFastest = 0.5, kSlowest = 100;
  constexpr double kForgets = 1.0 / 32;
  if (expected == 0 && slowness_ > 1) slowness_ -= (slowness_ - 1) * kForgets;
  if (expected < kLeastExpected) return;
  slowness_ = std::clamp((slowness_ + Seconds(took).count() / expected) / 2, kFastest, kSlowest);
}

pack::Hurry Slot::hurry(loop::Duration spacing) const {
  return {.bytes_per_second = bytes_per_second_, .slowness = slowness_, .longest = Seconds(spacing).count()};
}

void Slot::link_delivers(std::uint64_t bytes_per_second) {
  if (bytes_per_second == 0) return;
  bytes_per_second_ = std::min(bytes_per_second_, static_cast<double>(bytes_per_second));
}

void Slot::on_passed(std::size_t bytes) {
  largest_ = std::max(largest_, bytes);
  limit_ = std::max(limit_, bytes);
  ++smaller_;
}

/// If a larger message has passed, this one's sender alone has a limit.
void Slot::on_too_large(std::size_t bytes) {
  smaller_ = 0;
  if (bytes > largest_) limit_ = std::min(limit_, std::max(largest_, bytes / 2));
}

loop::Duration Slot::transfer(std::size_t bytes) const {
  return std::chrono::duration_cast<loop::Duration>(Seconds(static_cast<double>(bytes) / bytes_per_second_));
}

queues::PointsAt Slot::points_within(loop::Duration spacing) const {
  const double leave = std::max(bytes_per_second_ * Seconds(spacing).count(), kLeast);
  const double bytes = std::min(leave, kOfLimit * static_cast<double>(limit()));
  constexpr double kMost = 1e15;
  queues::PointsAt points{};
  std::ranges::transform(kOfExact, points.begin(), [&](double of_exact) {
    return static_cast<std::size_t>(std::min(bytes / (packed_to_ * of_exact), kMost));
  });
  return points;
}

namespace {

/// The damaged maps among the `unread` ones in `waiting`.
std::vector<MapStore::Damaged> damaged_in(const queues::QueuedMap& waiting,
                                          const std::vector<std::uint64_t>& unread) {
  std::vector<MapStore::Damaged> damaged;
  const auto look_at = [&](const queues::QueuedMap& one) {
    if (std::ranges::find(unread, one.updates.back()) == unread.end()) return;
    if (auto checked = codec::check_data(one.map); !checked)
      damaged.push_back({one.updates.back(), std::move(checked.error().sentence)});
  };
  if (waiting.parts.empty()) look_at(waiting);
  for (const queues::QueuedMap& part : waiting.parts) look_at(part);
  return damaged;
}

}  // namespace

PreparedMaps::PreparedMaps(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings,
                           TrafficCounts& counts, UriPace& pace, queues::MapQueue& queue, MapStore& store,
                           std::function<void(bool is_done)> packed)
    : loop_(loop),
      workers_(workers),
      settings_(settings),
      counts_(counts),
      pace_(pace),
      queue_(queue),
      store_(store),
      packed_(std::move(packed)),
      slot_(pace::map_bytes_per_second(settings.command_post.budget_mbit)),
      packing_(loop, [this] { store_.work_overruns(); }) {}

std::vector<const PreparedMap*> PreparedMaps::of(const Traffic& traffic) const {
  std::vector<const PreparedMap*> all;
  for (const PreparedMap* each : {first_.get(), following_.get()}) {
    if (each != nullptr && traffic_of(each->waiting.map) == traffic) all.push_back(each);
  }
  return all;
}

/// A worker that packs the map reads no bounds.
std::optional<queues::Replaced> PreparedMaps::absorb(const queues::QueuedMap& back) {
  for (const Place& place : {first_, following_}) {
    if (!place) continue;
    if (auto replaced = queues::absorb(place->waiting, back)) return replaced;
  }
  return {};
}

void PreparedMaps::prepare(bool follows, std::uint64_t delivers) {
  slot_.link_delivers(delivers);
  queue_.a_message_holds(slot_.points_within(pace_.spacing()));
  auto waiting = queue_.take(loop_.now());
  if (!waiting) return;
  Place& place = follows ? following_ : first_;
  place = std::make_shared<PreparedMap>(PreparedMap{.waiting = std::move(*waiting)});
  pack(place);
}

void PreparedMaps::pack(const Place& prepared) {
  icd::Header& header = prepared->waiting.map.header();
  header.stamp = pace_.next_stamp(header.stamp.value_or(loop_.stamp_now()));
  pace_.keep_stamp(*header.stamp);
  const loop::Instant began = loop_.now();
  const Packing packing{settings_.command_post.arrange_clouds, slot_.hurry(pace_.spacing())};
  const auto unread = store_.work_begins(prepared->waiting);
  workers_.submit(
      loop::Urgency::OnTheWay,
      [prepared, packing, unread, &loop = loop_, starts = packing_.begin(), file = store_.work_file()] {
        const loop::FaultCounter faults(file.c_str());
        const loop::Instant begins = loop.now();
        starts();
        prepared->damaged = damaged_in(prepared->waiting, unread);
        if (!prepared->damaged.empty()) return;
        prepared->packed = packed(prepared->waiting, packing);
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
        store_.work_ends(is_good, unread);
        if (is_good) slot_.packing_took(loop_.now() - began);
        work_done(prepared);
        packed_(true);
      },
      [this, prepared] { work_failed(prepared); });
  is_packing_ = true;
}

/// Null if it returned to the queue meanwhile.
PreparedMaps::Place* PreparedMaps::place_of(const Place& prepared) {
  if (prepared == first_) return &first_;
  return prepared == following_ ? &following_ : nullptr;
}

/// Records the damaged maps as failed and renames their files. The other parts are queued again, each alone.
void PreparedMaps::is_damaged(Place& place) {
  const auto it = place;
  queues::QueuedMap rest = it->waiting;
  std::vector<std::uint64_t> gone;
  for (const MapStore::Damaged& each : it->damaged) gone.push_back(each.number);
  const auto is_gone = [&](std::uint64_t number) { return std::ranges::find(gone, number) != gone.end(); };
  std::erase_if(rest.parts, [&](const queues::QueuedMap& part) { return is_gone(part.updates.back()); });
  std::erase_if(rest.updates, is_gone);
  store_.set_aside(it->damaged);
  if (!rest.parts.empty()) queue_.put_back_apart(std::move(rest));
  place.reset();  // the damaged maps are not retried
  for (const MapStore::Damaged& each : it->damaged) {
    counts_.not_taken(traffic_of(it->waiting.map), DeliveryFailure::Failed, 0,
                      "its stored copy is damaged: " + each.why);
  }
  store_.forget(gone);
}

/// Parts that cannot be stitched return to the queue, each alone.
void PreparedMaps::work_done(const Place& prepared) {
  if (prepared->damaged.empty()) {
    const Packed& packed = prepared->packed;
    slot_.worker_took(prepared->packing_took, packed.expected);
    slot_.packed(packed.points_size, packed.full_size, packed.precision);
  }
  Place* const place = place_of(prepared);
  if (place == nullptr) return;
  if (!prepared->damaged.empty()) return is_damaged(*place);
  if (prepared->packed.has_no_valid_point) return skip_piece(*place);
  if (prepared->packed.drawn) queue_.canvases().lay(prepared->waiting.map.name, *prepared->packed.drawn);
  prepared->packed.drawn.reset();
  if (!prepared->packed.body.empty()) {
    if (prepared->packed.stitched.raw_size > 0)
      prepared->waiting.map.data = std::move(prepared->packed.stitched);
    return;
  }
  host::log(host::Level::Warning, "cannot join grids: their data is damaged");
  queue_.put_back_apart(prepared->waiting);
  place->reset();
}

/// It has no valid point.
void PreparedMaps::skip_piece(Place& place) {
  const auto piece = std::exchange(place, nullptr);
  if (queues::next_piece(piece->waiting)) return store_.forget(queue_.put_back(std::move(piece->waiting)));
  counts_.replaced(traffic_of(piece->waiting.map), piece->waiting.updates.size());
  store_.forget(piece->waiting.updates);
}

void PreparedMaps::work_failed(const Place& prepared) {
  is_packing_ = false;
  packing_.end();
  store_.work_ends(false, {});
  prepared->packed = {};
  if (Place* const place = place_of(prepared)) {
    counts_.not_taken(traffic_of(prepared->waiting.map), DeliveryFailure::Failed, 0,
                      "it could not be compressed");
    put_back(*place);
  }
  packed_(false);
}

void PreparedMaps::leaves(const Place& sent) {
  if (sent == following_) return following_.reset();
  if (sent == first_) first_ = std::exchange(following_, nullptr);
}

void PreparedMaps::again(const Place& sent) {
  if (sent == first_) put_back(following_);
  if (Place* const place = place_of(sent)) put_back(*place);
  if (!first_) first_ = std::exchange(following_, nullptr);
}

/// Except one in flight.
void PreparedMaps::put_back(Place& prepared) {
  if (!prepared || prepared->is_under_way) return;
  const auto replaced = queue_.put_back(prepared->waiting);
  prepared.reset();
  store_.forget(replaced);
}

void PreparedMaps::pack_again() {
  put_back(following_);
  put_back(first_);
  queue_.restart_pieces();
  for (const Place& place : {first_, following_}) {
    if (place && std::exchange(place->waiting.piece, {}).size > 0) place->begins_again = true;
  }
}

}  // namespace adit::forward
