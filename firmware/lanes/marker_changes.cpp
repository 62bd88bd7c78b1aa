#include "lanes/marker_changes.hpp"

#include <algorithm>

namespace adit::lanes {

bool MarkerChanges::begins_with_delete_all() const {
  return !empty() && by_place_.begin()->second.action == icd::MarkerAction::DeleteAll;
}

MarkerChanges::Place MarkerChanges::apply(const icd::Marker& marker) {
  if (marker.action == icd::MarkerAction::DeleteAll) {
    by_place_.clear();
    places_.clear();
    by_place_.emplace(next_, marker);
    return next_++;
  }
  const Key key{marker.ns, marker.id};
  const auto known = places_.find(key);
  if (marker.action == icd::MarkerAction::Delete && begins_with_delete_all()) {
    if (known != places_.end()) {  // nothing of it is left to delete: what added it is all that goes
      by_place_.erase(known->second);
      places_.erase(known);
    }
    return by_place_.begin()->first;
  }
  if (known != places_.end()) {
    by_place_.at(known->second) = marker;
    return known->second;
  }
  by_place_.emplace(next_, marker);
  places_.emplace(key, next_);
  return next_++;
}

std::vector<icd::Marker> MarkerChanges::take(std::size_t most) {
  std::vector<icd::Marker> taken;
  taken.reserve(std::min(most, count()));
  while (!empty() && taken.size() < most) {
    auto change = by_place_.extract(by_place_.begin());
    const icd::Marker& marker = change.mapped();
    if (marker.action != icd::MarkerAction::DeleteAll) places_.erase({marker.ns, marker.id});
    taken.push_back(std::move(change.mapped()));
  }
  return taken;
}

}  // namespace adit::lanes
