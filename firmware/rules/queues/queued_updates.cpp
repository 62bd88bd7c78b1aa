#include "queues/queued_updates.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace adit::queues {

void QueuedUpdates::add(Place last, std::uint64_t count, Instant accepted) {
  if (const auto known = by_end_.find(last); known != by_end_.end()) {
    const Updates others = take(known);
    count += others.count;
    accepted = std::min(accepted, others.accepted);
  }
  by_end_.emplace(last, Updates{count, accepted});
  accepted_.insert(accepted);
}

QueuedUpdates::Updates QueuedUpdates::take(ByEnd::iterator updates) {
  const Updates taken = updates->second;
  accepted_.erase(accepted_.find(taken.accepted));
  by_end_.erase(updates);
  return taken;
}

void QueuedUpdates::move_first_to(Place last) {
  const Updates first = take(by_end_.begin());
  add(last, first.count, first.accepted);
}

std::uint64_t QueuedUpdates::take_done(const MarkerChanges& changes) {
  std::uint64_t done = 0;
  while (!empty() && (changes.empty() || by_end_.begin()->first < changes.in_order().begin()->first)) {
    done += take(by_end_.begin()).count;
  }
  return done;
}

void QueuedUpdates::join(const MarkerChanges& changes) {
  if (by_end_.size() <= 2 * (changes.size().count + 1)) return;
  const ByEnd all = std::exchange(by_end_, {});
  accepted_.clear();
  for (const auto& [last, updates] : all) {
    const auto after = changes.in_order().upper_bound(last);
    const Place end = after == changes.in_order().begin() ? kNowhere : std::prev(after)->first;
    add(end, updates.count, updates.accepted);
  }
}

}  // namespace adit::queues
