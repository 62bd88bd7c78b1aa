#include "forward/marker_scene.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

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
  held.bytes += entry.marker.size();
  held.in_order.emplace(entry.version, key);
  entries_.emplace(key, std::move(entry));
}

void MarkerScene::erase(const Key& key) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return;
  Held& held = found->second.gone ? gone_ : standing_;
  held.bytes -= found->second.marker.size();
  held.in_order.erase(found->second.version);
  entries_.erase(found);
}

void MarkerScene::keep_bounds() {
  const auto exceeds = [](const Held& held) {
    return held.in_order.size() > kMost || held.bytes > kMostBytes;
  };
  while (exceeds(standing_)) {
    const Key key = standing_.in_order.begin()->second;
    ++version_;  // a change of its own
    remove(key);
    ++left_out_;
  }
  while (exceeds(gone_)) {
    const auto [version, key] = *gone_.in_order.begin();
    forgotten_ = version;
    erase(key);
  }
}

api::MarkerChanges MarkerScene::changes(std::uint64_t since) const {
  const bool whole = since < forgotten_ || since > version_ || since == 0;
  api::MarkerChanges changes{
      .version = version_, .whole = whole, .left_out = left_out_, .markers = {}, .gone = {}};
  const auto news = [since, whole](const Held& held) {
    const auto& all = held.in_order;
    return std::ranges::subrange(whole ? all.begin() : all.upper_bound(since), all.end());
  };
  for (const auto& [version, key] : news(standing_)) {
    const Entry& entry = entries_.at(key);
    changes.markers.push_back({entry.marker, entry.at});
  }
  if (whole) return changes;
  for (const auto& [version, key] : news(gone_)) changes.gone.push_back(key);
  return changes;
}

}  // namespace adit::forward
