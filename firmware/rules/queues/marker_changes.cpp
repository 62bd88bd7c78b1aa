#include "queues/marker_changes.hpp"

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
  const bool is_known = known != places_.end() && !ByKey()(marker, known->first);
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

std::vector<icd::Marker> MarkerChanges::take(Size most) {
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
  std::map<Key, std::size_t, ByKey> bytes_now;  // of the markers that `newer` changes; 0: not queued
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

}  // namespace adit::queues
