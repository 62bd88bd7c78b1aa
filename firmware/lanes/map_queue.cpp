#include "lanes/map_queue.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "icd/require.hpp"

namespace adit::lanes {

std::vector<std::uint64_t> MapQueue::add(WaitingMap added) {
  const auto stays = [&](const WaitingMap& waiting) { return !replaces(added.map, waiting.map); };
  const auto first = added.map.is_grid() ? std::ranges::find_if_not(waiting_, stays) : waiting_.end();
  const auto gone = std::stable_partition(first, waiting_.end(), stays);
  std::vector<std::uint64_t> replaced;
  for (auto it = gone; it != waiting_.end(); ++it) {
    bytes_ -= bytes_held(*it);
    replaced.push_back(it->updates.back());
    take_over(added, std::move(*it));
  }
  waiting_.erase(gone, waiting_.end());
  bytes_ += bytes_held(added);
  waiting_.push_back(std::move(added));
  return replaced;
}

/// A grid that was made before goes first: sent after, its old cells would overwrite newer ones. Clouds wait
/// in the order of their age.
MapQueue::Maps::const_iterator MapQueue::ready(Instant now) const {
  const auto rests = [now](const WaitingMap& waiting) { return waiting.trial.rests(now); };
  const auto lets_others_pass = [&](const WaitingMap& waiting) {
    return rests(waiting) && (!waiting.map.is_grid() || waiting.trial.failures >= kInPlace);
  };
  const auto first = std::ranges::find_if_not(waiting_, lets_others_pass);
  return first == waiting_.end() || rests(*first) ? waiting_.end() : first;
}

bool MapQueue::is_ready(Instant now) const {
  return ready(now) != waiting_.end();
}

MapQueue::Maps::const_iterator MapQueue::rested_longest() const {
  icd::require(!waiting_.empty());
  if (waiting_.front().map.is_grid()) return waiting_.begin();
  return std::ranges::min_element(waiting_, {}, [](const WaitingMap& waiting) {
    return std::pair(waiting.trial.failed.value_or(Instant{}), waiting.accepted);
  });
}

std::pair<Instant, Instant> MapQueue::resting() const {
  const WaitingMap& waiting = *rested_longest();
  return {waiting.trial.failed.value_or(Instant{}), waiting.accepted};
}

WaitingMap MapQueue::take(Instant now, std::size_t merge_bytes) {
  const auto may_go = ready(now);
  const auto chosen = may_go == waiting_.end() ? rested_longest() : may_go;
  // It, and what is merged into it: they leave at last, when nothing can fail.
  std::vector<bool> leaves(waiting_.size());
  leaves[static_cast<std::size_t>(chosen - waiting_.begin())] = true;
  WaitingMap next = *chosen;
  merge_followers(next, merge_bytes, leaves);
  auto leaving = leaves.begin();
  std::erase_if(waiting_, [&](const WaitingMap& waiting) {
    if (!*leaving++) return false;
    bytes_ -= bytes_held(waiting);
    return true;
  });
  return next;
}

void MapQueue::merge_followers(WaitingMap& next, std::size_t merge_bytes, std::vector<bool>& leaves) const {
  const icd::PointCloud2* first = loose_cloud_in(next.map);
  bool open = first != nullptr && !next.alone && next.trial.failures == 0;
  for (std::size_t i = 0; i < waiting_.size() && open; ++i) {
    const WaitingMap& other = waiting_[i];
    if (leaves[i]) continue;
    if (other.trial.failures > 0) continue;  // what is on trial goes by itself
    const icd::PointCloud2* cloud = loose_cloud_in(other.map);
    open = cloud && !other.alone && mergeable(*first, *cloud) &&
           next.map.data.raw_size + other.map.data.raw_size <= merge_bytes;
    if (!open) return;
    leaves[i] = true;
    join_parts(next, other);
    next.map = merge(std::move(next.map), other.map);
    first = loose_cloud_in(next.map);
    next.updates.insert(next.updates.end(), other.updates.begin(), other.updates.end());
    next.accepted = std::min(next.accepted, other.accepted);
  }
}

std::vector<std::uint64_t> MapQueue::put_back(WaitingMap map) {
  const auto newer =
      std::ranges::find_if(waiting_, [&](const WaitingMap& waiting) { return replaces(waiting, map); });
  if (newer == waiting_.end()) {
    const std::size_t bytes = bytes_held(map);
    const auto place =
        std::ranges::find_if(waiting_, [&](const WaitingMap& waiting) { return is_newer(waiting, map); });
    waiting_.insert(place, std::move(map));
    bytes_ += bytes;
    return {};
  }
  std::vector<std::uint64_t> replaced{map.updates.back()};
  const std::size_t before = bytes_held(*newer);
  take_over(*newer, std::move(map));
  bytes_ += bytes_held(*newer) - before;
  return replaced;
}

void MapQueue::put_back_apart(WaitingMap map) {
  icd::require(!map.parts.empty() && map.parts.size() == map.updates.size());
  Maps all;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < map.parts.size(); ++i) {
    all.push_back({std::move(map.parts[i]), map.accepted, {map.updates[i]}, {}, true});
    bytes += bytes_held(all.back());
  }
  waiting_.insert(waiting_.begin(), std::move_iterator(all.begin()), std::move_iterator(all.end()));
  bytes_ += bytes;
}

void MapQueue::step_forward() {
  for (WaitingMap& each : waiting_) each.trial.steps_behind = false;
}

bool MapQueue::replaces_any(const icd::MapUpdate& map) const {
  return std::ranges::any_of(waiting_, [&](const WaitingMap& waiting) { return replaces(map, waiting.map); });
}

bool MapQueue::is_replaced(const WaitingMap& map) const {
  return std::ranges::any_of(waiting_, [&](const WaitingMap& waiting) { return replaces(waiting, map); });
}

std::optional<Instant> MapQueue::oldest() const {
  const auto oldest = std::ranges::min_element(waiting_, {}, &WaitingMap::accepted);
  return oldest == waiting_.end() ? std::nullopt : std::optional(oldest->accepted);
}

std::size_t MapQueue::largest_grid() const {
  std::size_t most = 0;
  for (const WaitingMap& waiting : waiting_) {
    if (waiting.map.is_grid()) most = std::max(most, waiting.map.data.bytes.size());
  }
  return most;
}

}  // namespace adit::lanes
