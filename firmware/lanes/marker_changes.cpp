#include "lanes/marker_changes.hpp"

#include <algorithm>
#include <iterator>

namespace adit::lanes {

bool MarkerChanges::begins_with_delete_all() const {
  return !empty() && by_place_.begin()->second.action == icd::MarkerAction::DeleteAll;
}

/// 0: no change of that ns and id waits.
std::size_t MarkerChanges::bytes_at(const Key& key) const {
  const auto known = places_.find(key);
  return known == places_.end() ? 0 : icd::bytes_of(by_place_.at(known->second));
}

MarkerChanges::Place MarkerChanges::apply(const icd::Marker& marker) {
  if (marker.action == icd::MarkerAction::DeleteAll) {
    by_place_.clear();
    places_.clear();
    by_place_.emplace(next_, marker);
    size_ = {1, icd::bytes_of(marker)};
    return next_++;
  }
  const Key key{marker.ns, marker.id};
  const std::size_t older = bytes_at(key);
  const auto known = places_.find(key);
  if (marker.action == icd::MarkerAction::Delete && begins_with_delete_all()) {
    if (known != places_.end()) {  // nothing of it is left to delete: what added it is all that goes
      by_place_.erase(known->second);
      places_.erase(known);
      size_ = {size_.count - 1, size_.bytes - older};
    }
    return by_place_.begin()->first;
  }
  size_ = {size_.count + (older == 0 ? 1 : 0), size_.bytes - older + icd::bytes_of(marker)};
  if (known != places_.end()) {
    by_place_.at(known->second) = marker;
    return known->second;
  }
  by_place_.emplace(next_, marker);
  places_.emplace(key, next_);
  return next_++;
}

std::optional<icd::Marker> MarkerChanges::remove(const icd::Marker& like) {
  auto place = by_place_.begin();
  if (like.action == icd::MarkerAction::DeleteAll) {
    if (!begins_with_delete_all()) return {};
  } else {
    const auto known = places_.find({like.ns, like.id});
    if (known == places_.end()) return {};
    place = by_place_.find(known->second);
    places_.erase(known);
  }
  auto change = by_place_.extract(place);
  size_ = {size_.count - 1, size_.bytes - icd::bytes_of(change.mapped())};
  return std::move(change.mapped());
}

std::vector<icd::Marker> MarkerChanges::take(Size most) {
  std::vector<icd::Marker> taken;
  taken.reserve(std::min(most.count, size_.count));
  std::size_t taken_bytes = 0;
  while (!empty() && taken.size() < most.count) {
    const std::size_t bytes = icd::bytes_of(by_place_.begin()->second);
    if (!taken.empty() && bytes > most.bytes - std::min(most.bytes, taken_bytes)) break;
    taken_bytes += bytes;
    size_ = {size_.count - 1, size_.bytes - bytes};
    auto change = by_place_.extract(by_place_.begin());
    const icd::Marker& marker = change.mapped();
    if (marker.action != icd::MarkerAction::DeleteAll) places_.erase({marker.ns, marker.id});
    taken.push_back(std::move(change.mapped()));
  }
  return taken;
}

MarkerChanges::Size MarkerChanges::size_with(const std::vector<icd::Marker>& newer) const {
  // What stands before the last DeleteAll leaves nothing.
  const auto wipe = std::find_if(newer.rbegin(), newer.rend(), [](const icd::Marker& marker) {
    return marker.action == icd::MarkerAction::DeleteAll;
  });
  const bool wiped = wipe != newer.rend();
  Size size = wiped ? Size{1, icd::bytes_of(*wipe)} : size_;
  std::map<Key, std::size_t> bytes_now;  // of those that `newer` changes; 0: none
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

}  // namespace adit::lanes
