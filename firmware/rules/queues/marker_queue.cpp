#include "queues/marker_queue.hpp"

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

namespace {

void age(icd::Marker& marker, icd::Stamp now) {
  if (marker.expires == 0) return;
  const double left = marker.expires - now;
  if (left > 0) {
    marker.lifetime = std::max(std::min(marker.lifetime, left), MarkerQueue::kLeastLifetime);
    return;
  }
  marker.action = icd::MarkerAction::Delete;
  marker.lifetime = marker.expires = 0;
  marker.text = marker.mesh_resource = "", marker.points = {}, marker.colors = {};
}

}  // namespace

void start_lifetimes(std::span<icd::Marker> accepted, icd::Stamp now) {
  for (icd::Marker& marker : accepted) {
    const bool has_one = marker.action == icd::MarkerAction::Add && marker.lifetime > 0;
    marker.expires = has_one ? now + marker.lifetime : 0;
  }
}

bool MarkerQueue::has_room_for(const icd::MarkersUpdate& update) const {
  if (empty()) return true;
  const MarkerChanges::Size now = changes_.size();
  std::size_t at_most = now.bytes;
  for (const icd::Marker& marker : update.markers) at_most += icd::bytes_of(marker);
  const bool is_far =
      now.count + update.markers.size() <= kMostMarkers && at_most <= bounds_.bytes - bounds_.bytes / 4;
  if (is_far) return true;
  const MarkerChanges::Size then = changes_.size_with(update.markers);
  const bool only_replaces = then.count <= now.count;
  const std::size_t most_bytes = only_replaces ? bounds_.bytes : bounds_.bytes - bounds_.bytes / 4;
  return then.count <= std::max(kMostMarkers, now.count) && then.bytes <= std::max(most_bytes, now.bytes);
}

icd::MarkersUpdate MarkerQueue::those_that_wait(const icd::MarkersUpdate& update) const {
  icd::MarkersUpdate known;
  for (const icd::Marker& marker : update.markers) {
    if (marker.action == icd::MarkerAction::DeleteAll) known.markers.clear();
    if (changes_.holds(marker)) known.markers.push_back(marker);
  }
  return known;
}

void MarkerQueue::add(icd::MarkersUpdate update, Instant now) {
  end_of_update(add_part(update.markers, QueuedUpdates::kNowhere), now);
}

MarkerChanges::Place MarkerQueue::add_part(std::span<icd::Marker> some, MarkerChanges::Place last) {
  for (icd::Marker& marker : some) {
    if (marker.action == icd::MarkerAction::DeleteAll) {
      needless_.push_back(changes_.wipe(std::move(marker)));
      last = changes_.in_order().begin()->first;
    } else {
      last = std::max(last, changes_.apply(std::move(marker)));
    }
  }
  return last;
}

void MarkerQueue::end_of_update(MarkerChanges::Place last, Instant now) {
  updates_.add(last, 1, now);
  updates_.join(changes_);
}

void MarkerQueue::keep_within(MarkerBounds bounds) {
  const bool is_narrow = most_now_ < bounds_.per_message;
  bounds_ = bounds;
  if (!is_narrow || most_now_ > bounds.per_message) most_now_ = bounds.per_message;
}

std::optional<QueuedMarkers> MarkerQueue::take(icd::Stamp now) {
  if (empty()) return {};
  QueuedMarkers taken;
  taken.accepted = *oldest();
  if (auto ahead = one_ahead()) {
    taken.update.markers.push_back(std::move(*ahead));
    taken.is_ahead = true;
  } else {
    taken.update.markers = changes_.take({most_now_, bounds_.bytes_per_message});
    taken.updates = updates_.take_done(changes_);
  }
  for (icd::Marker& marker : taken.update.markers) age(marker, now);
  return taken;
}

std::optional<icd::Marker> MarkerQueue::one_ahead() {
  if (!std::exchange(may_go_ahead_, false) || !changes_.begins_with_delete_all() || count() < 2) return {};
  const auto second = std::next(changes_.in_order().begin());
  auto next = changes_.in_order().upper_bound(std::max(ahead_, changes_.in_order().begin()->first));
  if (next == changes_.in_order().end()) next = second;
  ahead_ = next->first;
  return next->second;
}

void MarkerQueue::put_back(const QueuedMarkers& markers) {
  MarkerChanges older;
  for (const icd::Marker& marker : markers.update.markers) older.apply(marker);
  const auto last = changes_.apply_before(std::move(older));
  if (markers.updates > 0) updates_.add(last, markers.updates, markers.accepted);
  updates_.join(changes_);
}

void MarkerQueue::put_back_narrower(const QueuedMarkers& markers) {
  put_back(markers);
  most_now_ = std::max<std::size_t>(1, markers.update.markers.size() / 2);
}

void MarkerQueue::put_behind(const QueuedMarkers& markers) {
  if (markers.update.markers.size() != 1 || changes_.empty()) return put_back(markers);
  const icd::Marker& marker = markers.update.markers.front();
  if (marker.action == icd::MarkerAction::DeleteAll) {
    may_go_ahead_ = true;
    return put_back(markers);
  }
  const bool is_needless = changes_.says_more_than(marker);
  const auto last = is_needless ? changes_.in_order().rbegin()->first : changes_.apply(marker);
  if (markers.updates > 0) {
    updates_.add(last, markers.updates, markers.accepted);
  } else if (!is_needless && !updates_.empty()) {
    // The change becomes the end of its update, which is the first one. Otherwise its update would be done
    // when the other changes are gone.
    updates_.move_first_to(last);
  }
}

std::vector<icd::Marker> MarkerQueue::pending() const {
  std::vector<icd::Marker> all;
  all.reserve(count());
  for (const auto& [place, marker] : changes_.in_order()) all.push_back(marker);
  return all;
}

}  // namespace adit::queues
