#include "lanes/marker_lane.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace adit::lanes {

bool MarkerLane::has_room_for(const icd::MarkersUpdate& update) const {
  if (empty()) return true;
  const MarkerChanges::Size now = changes_.size(), then = changes_.size_with(update.markers);
  const bool only_replaces = then.count <= now.count;
  const std::size_t most_bytes = only_replaces ? bounds_.bytes : bounds_.bytes - bounds_.bytes / 4;
  return then.count <= std::max(kMostMarkers, now.count) && then.bytes <= std::max(most_bytes, now.bytes);
}

icd::MarkersUpdate MarkerLane::those_that_wait(const icd::MarkersUpdate& update) const {
  icd::MarkersUpdate known;
  for (const icd::Marker& marker : update.markers) {
    if (marker.action == icd::MarkerAction::DeleteAll) known.markers.clear();
    if (changes_.holds(marker)) known.markers.push_back(marker);
  }
  return known;
}

void MarkerLane::add(const icd::MarkersUpdate& update, Instant now) {
  Place last = kNowhere;
  for (const icd::Marker& marker : update.markers) last = std::max(last, changes_.apply(marker));
  add_to(updates_, last, {1, now});
  oldest_ = std::min(oldest_.value_or(now), now);
  if (updates_.size() > 2 * (count() + 1)) join_updates();
}

void MarkerLane::add_to(UpdatesByPlace& all, Place last, const Updates& updates) {
  const auto [found, is_new] = all.try_emplace(last, updates);
  if (is_new) return;
  found->second.count += updates.count;
  found->second.accepted = std::min(found->second.accepted, updates.accepted);
}

/// Updates whose last place is gone are done with the last one before it that is not: there are never many
/// more of them than changes.
void MarkerLane::join_updates() {
  UpdatesByPlace joined;
  for (const auto& [last, updates] : updates_) {
    const auto after = changes_.in_order().upper_bound(last);
    add_to(joined, after == changes_.in_order().begin() ? kNowhere : std::prev(after)->first, updates);
  }
  updates_ = std::move(joined);
}

void MarkerLane::keep_within(MarkerBounds bounds) {
  const bool is_narrow = most_now_ < bounds_.per_message;
  bounds_ = bounds;
  if (!is_narrow || most_now_ > bounds.per_message) most_now_ = bounds.per_message;
}

std::optional<WaitingMarkers> MarkerLane::take() {
  if (!oldest_) return {};
  WaitingMarkers taken;
  taken.accepted = *oldest_;
  if (auto ahead = one_ahead()) {
    taken.update.markers.push_back(std::move(*ahead));
    taken.is_ahead = true;
    return taken;
  }
  taken.update.markers = changes_.take({most_now_, bounds_.bytes_per_message});
  const auto still_waiting =
      changes_.empty() ? updates_.end() : updates_.lower_bound(changes_.in_order().begin()->first);
  for (auto done = updates_.begin(); done != still_waiting; ++done) taken.updates += done->second.count;
  updates_.erase(updates_.begin(), still_waiting);
  find_oldest();
  return taken;
}

std::optional<icd::Marker> MarkerLane::one_ahead() {
  if (!std::exchange(may_go_ahead_, false) || !changes_.begins_with_delete_all() || count() < 2) return {};
  const auto which = static_cast<std::ptrdiff_t>(1 + ahead_++ % (count() - 1));
  return std::next(changes_.in_order().begin(), which)->second;
}

void MarkerLane::put_back(const WaitingMarkers& markers) {
  MarkerChanges all;
  auto last = kNowhere;
  for (const icd::Marker& marker : markers.update.markers) last = std::max(last, all.apply(marker));

  UpdatesByPlace updates;
  if (markers.updates > 0) add_to(updates, last, {markers.updates, markers.accepted});
  // An update ends where the last of the changes up to its end has gone to.
  std::map<Place, Place> moved{{kNowhere, last}};
  for (const auto& [place, marker] : changes_.in_order()) {
    last = std::max(last, all.apply(marker));
    moved.emplace(place, last);
  }
  for (const auto& [place, waiting] : updates_) {
    add_to(updates, std::prev(moved.upper_bound(place))->second, waiting);
  }
  changes_ = std::move(all);
  updates_ = std::move(updates);
  find_oldest();
}

void MarkerLane::put_back_narrower(const WaitingMarkers& markers) {
  put_back(markers);
  most_now_ = std::max<std::size_t>(1, markers.update.markers.size() / 2);
}

void MarkerLane::put_behind(const WaitingMarkers& markers) {
  if (markers.update.markers.size() != 1 || changes_.empty()) return put_back(markers);
  const icd::Marker& marker = markers.update.markers.front();
  if (marker.action == icd::MarkerAction::DeleteAll) {
    may_go_ahead_ = true;
    return put_back(markers);
  }
  const bool is_needless = changes_.says_more_than(marker);
  const auto last = is_needless ? changes_.in_order().rbegin()->first : changes_.apply(marker);
  if (markers.updates > 0) {
    add_to(updates_, last, {markers.updates, markers.accepted});
  } else if (!is_needless && !updates_.empty()) {
    // It is the end of the update that it came in, which is the first that waits: otherwise nothing would
    // wait for it any more when the others have gone.
    const auto its = updates_.extract(updates_.begin());
    add_to(updates_, last, its.mapped());
  }
  find_oldest();
}

std::vector<icd::Marker> MarkerLane::pending() const {
  std::vector<icd::Marker> all;
  all.reserve(count());
  for (const auto& [place, marker] : changes_.in_order()) all.push_back(marker);
  return all;
}

void MarkerLane::find_oldest() {
  oldest_.reset();
  for (const auto& [last, updates] : updates_) {
    oldest_ = std::min(oldest_.value_or(updates.accepted), updates.accepted);
  }
}

}  // namespace adit::lanes
