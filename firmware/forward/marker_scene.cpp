#include "forward/marker_scene.hpp"

#include <algorithm>
#include <utility>

#include "icd/require.hpp"

namespace adit::forward {

/// Versions grow over a restart too: a page that comes back with an older one gets all.
void MarkerScene::begin_change(api::Time now) {
  const auto by_clock = now > 0 ? static_cast<std::uint64_t>(now * 1000) : 0;
  version_ = std::max(version_ + 1, by_clock);
}

void MarkerScene::forwarded(const icd::MarkersUpdate& update, api::Time now) {
  for (const icd::Marker& marker : update.markers) {
    begin_change(now);
    apply(marker, now);
    keep_bounds();
  }
}

void MarkerScene::wipe(api::Time now) {
  begin_change(now);
  clear();
  left_out_ = 0;
}

void MarkerScene::clear() {
  entries_.clear();
  in_order_.clear();
  standing_ = gone_ = {};
  forgotten_ = version_;
}

void MarkerScene::apply(const icd::Marker& marker, api::Time now) {
  const Key key{marker.ns, marker.id};
  switch (marker.action) {
    case icd::MarkerAction::DeleteAll:
      clear();
      left_out_ = 0;
      return;
    case icd::MarkerAction::Delete:
      return remove(key);
    case icd::MarkerAction::Add:
      return put(key, {.marker = api::drawn(marker), .at = now, .version = version_});
  }
}

void MarkerScene::remove(const Key& key) {
  const auto found = entries_.find(key);
  if (found == entries_.end() || found->second.gone) return;
  put(key, {.marker = {.ns = key.first}, .version = version_, .gone = true});
}

void MarkerScene::put(const Key& key, Entry entry) {
  erase(key);
  Held& held = entry.gone ? gone_ : standing_;
  ++held.count;
  held.bytes += entry.marker.size();
  in_order_.emplace(entry.version, key);
  entries_.emplace(key, std::move(entry));
}

void MarkerScene::erase(const Key& key) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return;
  Held& held = found->second.gone ? gone_ : standing_;
  --held.count;
  held.bytes -= found->second.marker.size();
  in_order_.erase(found->second.version);
  entries_.erase(found);
}

/// Requires that there is one.
MarkerScene::InOrder::const_iterator MarkerScene::oldest(bool gone) const {
  const auto found =
      std::ranges::find_if(in_order_, [&](const auto& one) { return entries_.at(one.second).gone == gone; });
  icd::require(found != in_order_.end());
  return found;
}

void MarkerScene::keep_bounds() {
  const auto exceeds = [](const Held& held) { return held.count > kMost || held.bytes > kMostBytes; };
  while (exceeds(standing_)) {
    const Key key = oldest(false)->second;
    ++version_;  // a change of its own
    remove(key);
    ++left_out_;
  }
  while (exceeds(gone_)) {
    const auto [version, key] = *oldest(true);
    forgotten_ = version;
    erase(key);
  }
}

api::MarkerChanges MarkerScene::changes(std::uint64_t since) const {
  const bool whole = since < forgotten_ || since > version_ || since == 0;
  api::MarkerChanges changes{
      .version = version_, .whole = whole, .left_out = left_out_, .markers = {}, .gone = {}};
  for (auto each = whole ? in_order_.begin() : in_order_.upper_bound(since); each != in_order_.end();
       ++each) {
    const Entry& entry = entries_.at(each->second);
    if (!entry.gone) {
      changes.markers.push_back({entry.marker, entry.at});
    } else if (!whole) {
      changes.gone.push_back(each->second);
    }
  }
  return changes;
}

}  // namespace adit::forward
