#include "lanes/marker_lane.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace adit::lanes {

std::vector<icd::Marker> merge(const std::vector<icd::Marker>& pending,
                               const std::vector<icd::Marker>& newer) {
  MarkerChanges changes;
  for (const icd::Marker& marker : pending) changes.apply(marker);
  for (const icd::Marker& marker : newer) changes.apply(marker);
  return changes.take(changes.count());
}

void MarkerLane::add(std::uint64_t number, const icd::MarkersUpdate& update, Instant now) {
  Update added{number, now, kNowhere};
  for (const icd::Marker& marker : update.markers) added.last = std::max(added.last, changes_.apply(marker));
  updates_.push_back(added);
}

std::optional<WaitingMarkers> MarkerLane::take() {
  const auto accepted = oldest();
  if (!accepted) return {};
  WaitingMarkers taken;
  taken.accepted = *accepted;
  taken.update.markers = changes_.take(most_);
  const auto still_waits = [&](const Update& update) {
    return !changes_.empty() && update.last >= changes_.in_order().begin()->first;
  };
  const auto done = std::stable_partition(updates_.begin(), updates_.end(), still_waits);
  std::ranges::transform(done, updates_.end(), std::back_inserter(taken.updates), &Update::number);
  updates_.erase(done, updates_.end());
  return taken;
}

void MarkerLane::put_back(const WaitingMarkers& markers) {
  MarkerChanges all;
  auto last = kNowhere;
  for (const icd::Marker& marker : markers.update.markers) last = std::max(last, all.apply(marker));

  std::vector<Update> updates;
  updates.reserve(markers.updates.size() + updates_.size());
  for (const std::uint64_t number : markers.updates) updates.push_back({number, markers.accepted, last});
  // An update ends where the last of the changes up to its end has gone to.
  std::map<MarkerChanges::Place, MarkerChanges::Place> moved{{kNowhere, last}};
  for (const auto& [place, marker] : changes_.in_order()) {
    last = std::max(last, all.apply(marker));
    moved.emplace(place, last);
  }
  for (const Update& update : updates_) {
    updates.push_back({update.number, update.accepted, std::prev(moved.upper_bound(update.last))->second});
  }
  changes_ = std::move(all);
  updates_ = std::move(updates);
}

std::vector<icd::Marker> MarkerLane::pending() const {
  std::vector<icd::Marker> all;
  all.reserve(count());
  for (const auto& [place, marker] : changes_.in_order()) all.push_back(marker);
  return all;
}

std::optional<Instant> MarkerLane::oldest() const {
  if (updates_.empty()) return {};
  return std::ranges::min_element(updates_, {}, &Update::accepted)->accepted;
}

}  // namespace adit::lanes
