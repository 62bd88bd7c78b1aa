#include "forward/marker_scene.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

namespace adit::forward {

/// Versions rise over restarts, so that pages with older ones get all markers.
void MarkerScene::begin_change(api::Time now) {
  const auto by_clock = now > 0 ? static_cast<std::uint64_t>(now * 1000) : 0;
  version_ = std::max(version_ + 1, by_clock);
}

void MarkerScene::forwarded(std::span<const icd::Marker> markers, api::Time now) {
  for (const icd::Marker& marker : markers) {
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
      return remove(entries_.find(key));
    case icd::MarkerAction::Add: {
      Entry entry{.marker = api::drawn(marker), .at = now, .version = version_};
      const auto [at, is_new] = entries_.try_emplace(key);
      if (!is_new) let_go(at->second);
      return put(at, std::move(entry));
    }
  }
}

void MarkerScene::remove(Entries::iterator at) {
  if (at == entries_.end() || at->second.gone) return;
  let_go(at->second);
  put(at, {.marker = {.ns = at->first.first}, .version = version_, .gone = true});
}

void MarkerScene::put(Entries::iterator at, Entry entry) {
  Held& held = held_with(entry);
  held.bytes += entry.marker.size();
  held.in_order.emplace_hint(held.in_order.end(), entry.version, at);
  at->second = std::move(entry);
}

void MarkerScene::let_go(const Entry& entry) {
  Held& held = held_with(entry);
  held.bytes -= entry.marker.size();
  held.in_order.erase(entry.version);
}

void MarkerScene::keep_bounds() {
  const auto exceeds = [](const Held& held) {
    return held.in_order.size() > kMost || held.bytes > kMostBytes;
  };
  while (exceeds(standing_)) {
    ++version_;  // a separate change
    remove(standing_.in_order.begin()->second);
    ++left_out_;
  }
  while (exceeds(gone_)) {
    const auto [version, at] = *gone_.in_order.begin();
    forgotten_ = version;
    let_go(at->second);
    entries_.erase(at);
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
  for (const auto& [version, at] : news(standing_))
    changes.markers.push_back({at->second.marker, at->second.at});
  if (whole) return changes;
  for (const auto& [version, at] : news(gone_)) changes.gone.push_back(at->first);
  return changes;
}

}  // namespace adit::forward
