#include "gateway/marker_scene.hpp"

#include <algorithm>
#include <iterator>

namespace adit::gateway {

/// Versions grow over a restart too: a page that comes back with an older one gets all.
void MarkerScene::begin_change(page::Time now) {
  const auto by_clock = now > 0 ? static_cast<std::uint64_t>(now * 1000) : 0;
  version_ = std::max(version_ + 1, by_clock);
}

void MarkerScene::forwarded(const icd::MarkersUpdate& update, page::Time now) {
  for (const icd::Marker& marker : update.markers) {
    begin_change(now);
    apply(marker, now);
    keep_bounds();
  }
}

void MarkerScene::wipe(page::Time now) {
  begin_change(now);
  clear();
  left_out_ = 0;
}

void MarkerScene::clear() {
  entries_.clear();
  in_order_.clear();
  standing_ = 0;
  forgotten_ = version_;
}

void MarkerScene::apply(const icd::Marker& marker, page::Time now) {
  const Key key{marker.ns, marker.id};
  switch (marker.action) {
    case icd::MarkerAction::DeleteAll:
      clear();
      left_out_ = 0;
      return;
    case icd::MarkerAction::Delete:
      return remove(key);
    case icd::MarkerAction::Add:
      break;
  }
  Entry& entry = entries_[key];
  if (entry.version == 0 || entry.gone) ++standing_;
  in_order_.erase(entry.version);
  entry = {.marker = marker, .at = now, .version = version_};
  in_order_.emplace(version_, key);
}

void MarkerScene::remove(const Key& key) {
  const auto found = entries_.find(key);
  if (found == entries_.end() || found->second.gone) return;
  in_order_.erase(found->second.version);
  found->second = {.marker = {}, .version = version_, .gone = true};
  in_order_.emplace(version_, key);
  --standing_;
}

void MarkerScene::keep_bounds() {
  if (standing_ > kMost) {
    const auto oldest =
        std::ranges::find_if(in_order_, [this](const auto& one) { return !entries_.at(one.second).gone; });
    ++version_;  // a change of its own
    remove(Key(oldest->second));
    ++left_out_;
  }
  if (entries_.size() - standing_ > kMost) {
    const auto oldest =
        std::ranges::find_if(in_order_, [this](const auto& one) { return entries_.at(one.second).gone; });
    forgotten_ = oldest->first;
    entries_.erase(oldest->second);
    in_order_.erase(oldest);
  }
}

page::MarkerNews MarkerScene::news(std::uint64_t since) const {
  const bool whole = since < forgotten_ || since > version_ || since == 0;
  page::MarkerNews news{
      .version = version_, .whole = whole, .left_out = left_out_, .markers = {}, .gone = {}};
  for (auto each = whole ? in_order_.begin() : in_order_.upper_bound(since); each != in_order_.end();
       ++each) {
    const Entry& entry = entries_.at(each->second);
    if (!entry.gone) {
      news.markers.push_back({entry.marker, entry.at});
    } else if (!whole) {
      news.gone.push_back(each->second);
    }
  }
  return news;
}

}  // namespace adit::gateway
