#include "queues/map_queue.hpp"

#include <algorithm>
#include <utility>

#include "icd/require.hpp"

namespace adit::queues {

/// Updates the sums over all queues. If `change` throws, it must have changed nothing.
template <class Change>
auto MapQueue::change(SenderQueue& queue, Change change) {
  const std::size_t count = queue.count(), bytes = queue.bytes();
  auto result = change(queue);
  count_ = count_ - count + queue.count();
  bytes_ = bytes_ - bytes + queue.bytes();
  return result;
}

const SenderQueue* MapQueue::queue_of(const Sender& sender) const {
  const auto found = senders_.find(sender);
  return found == senders_.end() ? nullptr : &found->second.queue;
}

/// The queue of a sender that is about to get a map.
MapQueue::Waiting& MapQueue::joins(const Sender& sender) {
  Waiting& its = senders_[sender];
  if (its.queue.count() == 0) its.turn = turns_.joins(its.turn);
  return its;
}

Clouds MapQueue::clouds_of(const Sender& sender) const {
  if (!sender.name) return Clouds::Auto;
  const auto found = clouds_.find(*sender.name);
  return found == clouds_.end() ? Clouds::Auto : found->second;
}

QueuedMap MapQueue::waiting(std::uint64_t number, icd::MapUpdate map, Instant now) const {
  QueuedMap made{.map = std::move(map), .accepted = now, .updates = {number}};
  made.is_whole = !made.map.is_grid() && clouds_of(Sender::of(made.map)) == Clouds::Whole;
  return made;
}

Replaced MapQueue::add(std::uint64_t number, icd::MapUpdate map, Instant now) {
  QueuedMap added = waiting(number, std::move(map), now);
  Waiting& its = joins(Sender::of(added.map));
  inherit(added.trial, its.trial);
  return change(its.queue, [&](SenderQueue& queue) { return queue.add(std::move(added)); });
}

void MapQueue::restore(std::uint64_t number, icd::MapUpdate map, Instant now,
                       std::optional<icd::GridBounds> bounds, PackingRule packing) {
  QueuedMap restored = waiting(number, std::move(map), now);
  restored.bounds = bounds;
  restored.packing = packing;
  Waiting& its = joins(Sender::of(restored.map));
  change(its.queue, [&](SenderQueue& queue) {
    queue.append(std::move(restored));
    return true;
  });
}

/// The sender whose turn it is, among those with a map that may go. If all maps rest, the sender of the map
/// that has rested longest.
MapQueue::Senders::iterator MapQueue::next(Instant now) {
  auto next = senders_.end();
  for (auto each = senders_.begin(); each != senders_.end(); ++each) {
    if (next != senders_.end() && next->second.turn < each->second.turn) continue;
    if (each->second.queue.is_ready(now)) next = each;
  }
  if (next != senders_.end()) return next;
  for (auto each = senders_.begin(); each != senders_.end(); ++each) {
    const SenderQueue& queue = each->second.queue;
    if (queue.count() == 0) continue;
    if (next == senders_.end() || queue.resting() < next->second.queue.resting()) next = each;
  }
  return next;
}

Precision MapQueue::precision_of(const Sender& sender, const SenderQueue& queue) const {
  if (sender.is_grid || !sender.name) return Precision::Exact;
  const auto found = precisions_.find(*sender.name);
  if (found == precisions_.end()) return Precision::Exact;
  return found->second == Precision::Auto ? precision_for(queue.bytes(), holds_) : found->second;
}

std::optional<QueuedMap> MapQueue::take(Instant now) {
  if (count_ == 0) return {};
  const auto chosen = next(now);
  Waiting& its = chosen->second;
  const Precision precision = precision_of(chosen->first, its.queue);
  const std::size_t most = std::min(merge_bytes_, holds_[static_cast<std::size_t>(precision)]);
  QueuedMap taken = change(its.queue, [&](SenderQueue& queue) { return queue.take(now, most, canvases_); });
  taken.precision = precision;
  its.turn = turns_.served(its.turn);
  forget_those_that_are_gone();
  for (auto& [sender, waiting] : senders_) waiting.queue.step_forward();
  return taken;
}

void MapQueue::forget_those_that_are_gone() {
  std::erase_if(senders_, [&](const auto& each) {
    return each.second.queue.count() == 0 && !turns_.has_to_pay(each.second.turn) &&
           !each.second.trial.failed;
  });
}

void MapQueue::on_too_large(const Sender& sender, const Trial& trial) {
  Waiting& its = senders_[sender];
  its.trial = trial;
  its.trial.failures = 0;
  its.trial.steps_behind = false;
  its.queue.inherit(its.trial);
}

void MapQueue::on_passed(const Sender& sender) {
  const auto found = senders_.find(sender);
  if (found == senders_.end() || !found->second.trial.failed) return;
  found->second.trial = {};
  found->second.queue.inherit({});
}

void MapQueue::carried(const Sender& sender, std::size_t bytes) {
  icd::require(slot_bytes_ > 0);
  if (bytes <= slot_bytes_) return;
  Waiting& its = senders_[sender];
  if (its.turn == Turn{}) its.turn = turns_.joins({});
  its.turn = turns_.owes(its.turn, (bytes - 1) / slot_bytes_);
}

Replaced MapQueue::put_back(QueuedMap map) {
  Waiting& its = joins(Sender::of(map.map));
  return change(its.queue, [&](SenderQueue& queue) { return queue.put_back(std::move(map)); });
}

void MapQueue::put_back_apart(QueuedMap map) {
  Waiting& its = joins(Sender::of(map.map));
  change(its.queue, [&](SenderQueue& queue) {
    queue.put_back_apart(std::move(map));
    return true;
  });
}

void MapQueue::put_back_halves(QueuedMap map) {
  Waiting& its = joins(Sender::of(map.map));
  change(its.queue, [&](SenderQueue& queue) {
    queue.put_back_halves(std::move(map));
    return true;
  });
}

void MapQueue::restart_pieces() {
  for (auto& [sender, waiting] : senders_) waiting.queue.restart_pieces();
}

std::optional<Successive> MapQueue::to_compare() const {
  for (const auto& [sender, waiting] : senders_) {
    if (sender.is_grid || clouds_of(sender) != Clouds::Auto) continue;
    if (auto two = waiting.queue.to_compare()) return two;
  }
  return {};
}

std::vector<std::uint64_t> MapQueue::replace(const Successive& two) {
  const auto found = senders_.find(two.sender);
  if (found == senders_.end()) return {};
  return change(found->second.queue, [&](SenderQueue& queue) { return queue.replace(two); });
}

void MapQueue::keep_both(const Successive& two) {
  const auto found = senders_.find(two.sender);
  if (found != senders_.end()) found->second.queue.keep_both(two);
}

bool MapQueue::replaces_any(const icd::MapUpdate& map) const {
  const SenderQueue* queue = queue_of(Sender::of(map));
  return queue != nullptr && queue->replaces_any(waiting(0, map, {}));
}

bool MapQueue::joins(const icd::MapUpdate& map) const {
  const SenderQueue* queue = queue_of(Sender::of(map));
  return queue != nullptr && queue->joins(waiting(0, map, {}));
}

std::optional<Replaced> MapQueue::absorb(const QueuedMap& map) {
  const auto found = senders_.find(Sender::of(map.map));
  return found == senders_.end() ? std::nullopt : found->second.queue.absorb(map);
}

std::size_t MapQueue::count(const Sender& sender) const {
  const SenderQueue* queue = queue_of(sender);
  return queue == nullptr ? 0 : queue->count();
}

std::optional<Instant> MapQueue::oldest(const Sender& sender) const {
  const SenderQueue* queue = queue_of(sender);
  return queue == nullptr ? std::nullopt : queue->oldest();
}

std::size_t MapQueue::largest_replaceable() const {
  std::size_t most = 0;
  for (const auto& [sender, waiting] : senders_) most = std::max(most, waiting.queue.largest_replaceable());
  return most;
}

}  // namespace adit::queues
