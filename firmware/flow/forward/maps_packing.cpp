// How the next map is packed on a worker, and with what effort.
#include <algorithm>
#include <utility>

#include "codec/read.hpp"
#include "forward/maps.hpp"
#include "host/log.hpp"

namespace adit::forward {

void Maps::prepare(Place& place) {
  auto prepared = std::make_shared<Prepared>();
  slot_.link_delivers(channel_.delivers());
  queue_.a_message_holds(slot_.points_within(pace_.spacing()));
  auto waiting = queue_.take(loop_.now());
  if (!waiting) return;
  prepared->waiting = std::move(*waiting);
  place = std::move(prepared);
  pack(place);
}

void Maps::pack(const Place& prepared) {
  icd::Header& header = prepared->waiting.map.header();
  header.stamp = stamps_.next(header.stamp.value_or(loop_.stamp_now()));
  journal_.stamped(icd::Uri::MapUpdate, *header.stamp);
  const loop::Instant began = loop_.now();
  const auto leaving_out = std::make_shared<LeavingOut>(points_.leaving_out(prepared->waiting.map));
  const Packing packing{settings_.command_post.arrange_clouds, slot_.hurry(pace_.spacing())};
  const auto unread = unread_in(prepared->waiting);
  std::vector<std::uint64_t> own;
  queues::add_own_numbers(own, prepared->waiting);
  spool_.work_begins(own);
  workers_.submit(
      loop::Urgency::OnTheWay,
      [prepared, leaving_out, packing, unread, &loop = loop_] {
        const loop::Instant begins = loop.now();
        prepared->damaged = damaged_in(prepared->waiting, unread);
        if (!prepared->damaged.empty()) return;
        prepared->packed = packed(prepared->waiting, std::move(*leaving_out), packing);
        prepared->packing_took = loop.now() - begins;
        if (!prepared->packed.body.empty() || prepared->packed.left_out.is_all) return;
        std::vector<std::uint64_t> numbers;
        queues::add_own_numbers(numbers, prepared->waiting);
        prepared->damaged = damaged_in(prepared->waiting, numbers);
      },
      [this, began, prepared, unread] {
        preparing_ = false;
        spool_.work_ends();
        if (prepared->damaged.empty()) {
          for (const std::uint64_t number : unread) unread_.erase(number);
          slot_.packing_took(loop_.now() - began);
        }
        is_packed(prepared);
        pump();
      },
      [this, prepared] { not_packed(prepared); });
  preparing_ = true;
}

/// Null where it went back into the queue meanwhile.
Maps::Place* Maps::place_of(const Place& prepared) {
  if (prepared == prepared_) return &prepared_;
  return prepared == following_ ? &following_ : nullptr;
}

void Maps::learn_from(const Prepared& prepared) {
  const Packed& packed = prepared.packed;
  slot_.worker_took(prepared.packing_took, packed.expected);
  slot_.packed(packed.points_size, packed.full_size, packed.precision);
}

/// The numbers of those maps in `waiting` whose data is still to be checked.
std::vector<std::uint64_t> Maps::unread_in(const queues::QueuedMap& waiting) const {
  std::vector<std::uint64_t> numbers;
  if (!unread_.empty()) queues::add_own_numbers(numbers, waiting);
  std::erase_if(numbers, [this](std::uint64_t number) { return !unread_.contains(number); });
  return numbers;
}

std::vector<Maps::Damaged> Maps::damaged_in(const queues::QueuedMap& waiting,
                                            const std::vector<std::uint64_t>& unread) {
  std::vector<Damaged> damaged;
  const auto look_at = [&](const queues::QueuedMap& one) {
    if (std::ranges::find(unread, one.updates.back()) == unread.end()) return;
    if (auto checked = codec::check_data(one.map); !checked)
      damaged.push_back({one.updates.back(), std::move(checked.error().sentence)});
  };
  if (waiting.parts.empty()) look_at(waiting);
  for (const queues::QueuedMap& part : waiting.parts) look_at(part);
  return damaged;
}

/// Records the damaged maps as failed and renames their files. The other parts are queued again, each alone.
void Maps::is_damaged(Place& place) {
  const auto it = place;
  queues::QueuedMap rest = it->waiting;
  std::vector<std::uint64_t> gone;
  for (const Damaged& each : it->damaged) gone.push_back(each.number);
  const auto is_gone = [&](std::uint64_t number) { return std::ranges::find(gone, number) != gone.end(); };
  std::erase_if(rest.parts, [&](const queues::QueuedMap& part) { return is_gone(part.updates.back()); });
  std::erase_if(rest.updates, is_gone);
  writer_.submit(
      [&spool = spool_, it] {
        for (const Damaged& each : it->damaged) spool.set_aside(each.number, each.why);
      },
      [] {});
  if (!rest.parts.empty()) queue_.put_back_apart(std::move(rest));
  place.reset();  // nothing of what is damaged is tried again
  for (const Damaged& each : it->damaged) {
    unread_.erase(each.number);
    record_.not_taken(traffic_of(it->waiting.map), NotTaken::Failed, 0,
                      "its stored copy is damaged: " + each.why);
  }
  forget(gone);
}

/// What cannot be stitched goes as it came, each part by itself.
void Maps::is_packed(const Place& prepared) {
  const LeftOut& left_out = prepared->packed.left_out;
  if (prepared->damaged.empty()) learn_from(*prepared);
  Place* const place = place_of(prepared);
  if (place == nullptr) return;
  if (!prepared->damaged.empty()) return is_damaged(*place);
  if (left_out.is_all) return is_there(*place);
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

void Maps::not_packed(const Place& prepared) {
  preparing_ = false;
  spool_.work_ends();
  pace_.failed(loop_.now());
  prepared->packed = {};
  if (Place* const place = place_of(prepared)) {
    record_.not_taken(traffic_of(prepared->waiting.map), NotTaken::Failed, 0, "it could not be compressed");
    put_back(*place);
  }
  wake_.call_at(pace_.ready());
}

}  // namespace adit::forward
