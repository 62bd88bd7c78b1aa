#include "queues/marker_queue.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace adit::queues {

bool MarkerChanges::begins_with_delete_all() const {
  return !empty() && by_place_.begin()->second.action == icd::MarkerAction::DeleteAll;
}

/// 0 if no change of that ns and id is queued.
std::size_t MarkerChanges::bytes_at(const Key& key) const {
  const auto known = places_.find(key);
  return known == places_.end() ? 0 : icd::bytes_of(by_place_.at(known->second));
}

void MarkerChanges::insert(Place place, icd::Marker&& marker, Places::const_iterator next) {
  size_ = {size_.count + 1, size_.bytes + icd::bytes_of(marker)};
  if (marker.action != icd::MarkerAction::DeleteAll)
    places_.emplace_hint(next, Key{marker.ns, marker.id}, place);
  if (marker.action == icd::MarkerAction::Delete) deletes_.insert(deletes_.end(), place);
  by_place_.emplace_hint(by_place_.end(), place, std::move(marker));
}

void MarkerChanges::replace(InOrder::iterator older, icd::Marker&& marker) {
  size_.bytes = size_.bytes - icd::bytes_of(older->second) + icd::bytes_of(marker);
  if (older->second.action == icd::MarkerAction::Delete) deletes_.erase(older->first);
  if (marker.action == icd::MarkerAction::Delete) deletes_.insert(older->first);
  older->second = std::move(marker);
}

icd::Marker MarkerChanges::extract(InOrder::iterator change) {
  icd::Marker marker = std::move(change->second);
  size_ = {size_.count - 1, size_.bytes - icd::bytes_of(marker)};
  if (marker.action != icd::MarkerAction::DeleteAll) places_.erase(places_.find(marker));
  if (marker.action == icd::MarkerAction::Delete) deletes_.erase(change->first);
  by_place_.erase(change);
  return marker;
}

MarkerChanges MarkerChanges::wipe(icd::Marker delete_all) {
  MarkerChanges needless = std::exchange(*this, {});
  next_ = needless.next_;
  insert(next_++, std::move(delete_all));
  return needless;
}

MarkerChanges::Place MarkerChanges::apply(icd::Marker marker) {
  if (marker.action == icd::MarkerAction::DeleteAll) {
    wipe(std::move(marker));
    return next_ - 1;
  }
  const auto known = places_.lower_bound(marker);
  const bool is_known = known != places_.end() && !KeyLess()(marker, known->first);
  if (marker.action == icd::MarkerAction::Delete && begins_with_delete_all()) {
    // The DeleteAll removes the marker at the Command Post. Only its queued change is dropped.
    if (is_known) extract(known->second);
    return by_place_.begin()->first;
  }
  const Place place = is_known ? known->second : next_++;
  if (is_known) {
    replace(by_place_.find(place), std::move(marker));
  } else {
    insert(place, std::move(marker), known);
  }
  return place;
}

MarkerChanges::Place MarkerChanges::apply_before(MarkerChanges older) {
  const Place first = empty() ? next_ : by_place_.begin()->first;
  if (begins_with_delete_all()) return first - 1;
  if (older.begins_with_delete_all()) {
    while (!deletes_.empty()) older.remove(extract(*deletes_.begin()));
  }
  Place place = first - static_cast<Place>(older.size().count);
  for (auto& [its, marker] : older.by_place_) {
    const auto newer = places_.find(marker);
    const bool stands = marker.action == icd::MarkerAction::DeleteAll || newer == places_.end();
    insert(place++, stands ? std::move(marker) : extract(newer->second));
  }
  return first - 1;
}

std::optional<icd::Marker> MarkerChanges::remove(const icd::Marker& like) {
  if (like.action == icd::MarkerAction::DeleteAll) {
    if (!begins_with_delete_all()) return {};
    return extract(by_place_.begin());
  }
  const auto known = places_.find(like);
  if (known == places_.end()) return {};
  return extract(known->second);
}

std::vector<icd::Marker> MarkerChanges::pop(Size most) {
  std::vector<icd::Marker> taken;
  taken.reserve(std::min(most.count, size_.count));
  std::size_t taken_bytes = 0;
  while (!empty() && taken.size() < most.count) {
    const std::size_t bytes = icd::bytes_of(by_place_.begin()->second);
    if (!taken.empty() && bytes > most.bytes - std::min(most.bytes, taken_bytes)) break;
    taken_bytes += bytes;
    taken.push_back(extract(by_place_.begin()));
  }
  return taken;
}

MarkerChanges::Size MarkerChanges::size_with(const std::vector<icd::Marker>& newer) const {
  // Changes before the last DeleteAll have no effect.
  const auto wipe = std::find_if(newer.rbegin(), newer.rend(), [](const icd::Marker& marker) {
    return marker.action == icd::MarkerAction::DeleteAll;
  });
  const bool wiped = wipe != newer.rend();
  Size size = wiped ? Size{1, icd::bytes_of(*wipe)} : size_;
  std::map<Key, std::size_t, KeyLess> bytes_now;  // of the markers that `newer` changes; 0: not queued
  for (auto marker = wiped ? wipe.base() : newer.begin(); marker != newer.end(); ++marker) {
    const Key key{marker->ns, marker->id};
    std::size_t& bytes = bytes_now.try_emplace(key, wiped ? 0 : bytes_at(key)).first->second;
    const bool vanishes = marker->action == icd::MarkerAction::Delete && (wiped || begins_with_delete_all());
    const std::size_t after = vanishes ? 0 : icd::bytes_of(*marker);
    size = {size.count + (after > 0 ? 1 : 0) - (bytes > 0 ? 1 : 0), size.bytes + after - bytes};
    bytes = after;
  }
  return size;
}

void QueuedUpdates::add(Place last, std::uint64_t count, Instant accepted) {
  if (const auto known = by_end_.find(last); known != by_end_.end()) {
    const Updates others = extract(known);
    count += others.count;
    accepted = std::min(accepted, others.accepted);
  }
  by_end_.emplace(last, Updates{count, accepted});
  accepted_.insert(accepted);
}

QueuedUpdates::Updates QueuedUpdates::extract(ByEnd::iterator updates) {
  const Updates taken = updates->second;
  accepted_.erase(accepted_.find(taken.accepted));
  by_end_.erase(updates);
  return taken;
}

void QueuedUpdates::move_first_to(Place last) {
  const Updates first = extract(by_end_.begin());
  add(last, first.count, first.accepted);
}

std::uint64_t QueuedUpdates::remove_done(const MarkerChanges& changes) {
  std::uint64_t done = 0;
  while (!empty() &&
         (changes.empty() || by_end_.begin()->first < changes.changes_by_place().begin()->first)) {
    done += extract(by_end_.begin()).count;
  }
  return done;
}

void QueuedUpdates::join(const MarkerChanges& changes) {
  if (by_end_.size() <= 2 * (changes.size().count + 1)) return;
  const ByEnd all = std::exchange(by_end_, {});
  accepted_.clear();
  for (const auto& [last, updates] : all) {
    const auto after = changes.changes_by_place().upper_bound(last);
    const Place end = after == changes.changes_by_place().begin() ? kNowhere : std::prev(after)->first;
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

icd::MarkersUpdate MarkerQueue::queued_changes(const icd::MarkersUpdate& update) const {
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
      last = changes_.changes_by_place().begin()->first;
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

void MarkerQueue::set_bounds(MarkerBounds bounds) {
  const bool is_narrow = most_now_ < bounds_.per_message;
  bounds_ = bounds;
  if (!is_narrow || most_now_ > bounds.per_message) most_now_ = bounds.per_message;
}

std::optional<QueuedMarkers> MarkerQueue::pop(icd::Stamp now) {
  if (empty()) return {};
  QueuedMarkers taken;
  taken.accepted = *oldest();
  if (auto ahead = copy_later_change()) {
    taken.update.markers.push_back(std::move(*ahead));
    taken.is_ahead = true;
  } else {
    taken.update.markers = changes_.pop({most_now_, bounds_.bytes_per_message});
    taken.updates = updates_.remove_done(changes_);
  }
  for (icd::Marker& marker : taken.update.markers) age(marker, now);
  return taken;
}

std::optional<icd::Marker> MarkerQueue::copy_later_change() {
  if (!std::exchange(may_go_ahead_, false) || !changes_.begins_with_delete_all() || count() < 2) return {};
  const auto second = std::next(changes_.changes_by_place().begin());
  auto next =
      changes_.changes_by_place().upper_bound(std::max(ahead_, changes_.changes_by_place().begin()->first));
  if (next == changes_.changes_by_place().end()) next = second;
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

void MarkerQueue::requeue_last(const QueuedMarkers& markers) {
  if (markers.update.markers.size() != 1 || changes_.empty()) return put_back(markers);
  const icd::Marker& marker = markers.update.markers.front();
  if (marker.action == icd::MarkerAction::DeleteAll) {
    may_go_ahead_ = true;
    return put_back(markers);
  }
  const bool is_needless = changes_.supersedes(marker);
  const auto last = is_needless ? changes_.changes_by_place().rbegin()->first : changes_.apply(marker);
  if (markers.updates > 0) {
    updates_.add(last, markers.updates, markers.accepted);
  } else if (!is_needless && !updates_.empty()) {
    // The change now ends its update, the first one; else that would be done when the others are gone.
    updates_.move_first_to(last);
  }
}

std::vector<icd::Marker> MarkerQueue::pending() const {
  std::vector<icd::Marker> all;
  all.reserve(count());
  for (const auto& [place, marker] : changes_.changes_by_place()) all.push_back(marker);
  return all;
}

}  // namespace adit::queues
