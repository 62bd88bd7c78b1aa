#include "lanes/map_lane.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "icd/require.hpp"

namespace adit::lanes {
namespace {

/// The cloud whose points can be joined to others; null for a grid and for packed points.
const icd::PointCloud2* loose_cloud_in(const icd::MapUpdate& map) {
  if (map.data.compression != icd::Compression::None) return nullptr;
  return std::get_if<icd::PointCloud2>(&map.msg);
}

/// What one waiting map keeps in memory beside its data: itself, its fields, and what allocators add.
std::size_t bytes_held(const WaitingMap& waiting) {
  constexpr std::size_t kFrame = 1024;
  std::size_t bytes = kFrame + waiting.map.data.bytes.size() + waiting.updates.size() * sizeof(std::uint64_t);
  if (const auto* cloud = std::get_if<icd::PointCloud2>(&waiting.map.msg)) {
    for (const auto& field : cloud->fields) bytes += sizeof field + field.name.size();
  }
  return bytes;
}

bool replaces(const icd::MapUpdate& newer, const icd::MapUpdate& older) {
  const auto* const new_grid = std::get_if<icd::OccupancyGrid>(&newer.msg);
  const auto* const old_grid = std::get_if<icd::OccupancyGrid>(&older.msg);
  return new_grid && old_grid && newer.name == older.name && covers(*new_grid, *old_grid);
}

/// Of one that waits, and one that comes back to the lane. A clock that was set back gives many maps one
/// stamp: of these, which are sent again oldest first, the later one is newer.
bool is_newer(const WaitingMap& waiting, const WaitingMap& back) {
  if (!waiting.again) return true;
  return back.again &&
         std::pair(*waiting.again, waiting.updates.back()) > std::pair(*back.again, back.updates.back());
}

/// What is merged keeps what it was merged of: the bytes are shared, so that this costs next to nothing.
void join_parts(WaitingMap& to, const WaitingMap& from) {
  if (to.parts.empty()) to.parts.push_back(to.map);
  if (from.parts.empty()) {
    to.parts.push_back(from.map);
  } else {
    to.parts.insert(to.parts.end(), from.parts.begin(), from.parts.end());
  }
}

/// `from` is older news: its updates become `to`'s as well, and its age counts.
void take_over(WaitingMap& to, WaitingMap from) {
  const auto middle = static_cast<std::ptrdiff_t>(from.updates.size());
  from.updates.insert(from.updates.end(), to.updates.begin(), to.updates.end());
  to.updates = std::move(from.updates);
  std::inplace_merge(to.updates.begin(), to.updates.begin() + middle, to.updates.end());
  to.accepted = std::min(to.accepted, from.accepted);
  // Its place and its rests, too, but it is to fail by itself before it is blamed.
  if (to.trial.failures > 0) return;
  to.trial = from.trial;
  to.trial.strikes = std::min(to.trial.strikes, Blame::kMostStrikes - 2);
}

}  // namespace

bool replaces(const WaitingMap& newer, const WaitingMap& older) {
  return is_newer(newer, older) && replaces(newer.map, older.map);
}

bool mergeable(const icd::PointCloud2& a, const icd::PointCloud2& b) {
  return a.fields == b.fields && a.point_step == b.point_step && a.is_bigendian == b.is_bigendian &&
         a.origin.value_or(icd::Pose{}) == b.origin.value_or(icd::Pose{});
}

icd::MapUpdate merge(icd::MapUpdate older, const icd::MapUpdate& newer) {
  icd::require(older.name == newer.name && !older.is_grid() && !newer.is_grid());
  older.msg = newer.msg;
  older.data.bytes.append(newer.data.bytes);
  older.data.raw_size += newer.data.raw_size;
  return older;
}

std::vector<std::uint64_t> MapLane::add(std::uint64_t number, icd::MapUpdate map, Instant now) {
  WaitingMap added{std::move(map), now, {number}, {}, false};
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

/// The oldest news of those that do not rest; where all do, what rested longest. Grids of the same name that
/// were made before it go first: sent after it, their old cells would overwrite its new ones.
MapLane::Place MapLane::choose(Instant now) {
  const auto passable = [&](const WaitingMap& waiting) {
    return waiting.trial.failures >= kInPlace && waiting.trial.rests(now);
  };
  std::set<std::optional<icd::RobotName>> held_up;  // names whose grids wait behind one that rests
  auto chosen = waiting_.end();
  for (auto each = waiting_.begin(); each != waiting_.end(); ++each) {
    const bool grid = each->map.is_grid();
    if (each->trial.rests(now)) {
      if (grid && !passable(*each)) held_up.insert(each->map.name);
    } else if (!(grid && held_up.contains(each->map.name)) &&
               (chosen == waiting_.end() || each->accepted < chosen->accepted)) {
      chosen = each;
    }
  }
  const bool all_rest = chosen == waiting_.end();
  if (all_rest) {
    chosen = std::ranges::min_element(waiting_, {}, [](const WaitingMap& waiting) {
      return std::pair(waiting.trial.failed.value_or(Instant{}), waiting.accepted);
    });
  }
  if (!chosen->map.is_grid()) return chosen;
  return std::ranges::find_if(waiting_, [&](const WaitingMap& waiting) {
    return waiting.map.is_grid() && waiting.map.name == chosen->map.name && (all_rest || !passable(waiting));
  });
}

std::optional<WaitingMap> MapLane::take(Instant now) {
  if (waiting_.empty()) return {};
  const auto chosen = choose(now);
  std::vector<bool> leaves(
      waiting_.size());  // it, and what is merged into it: at last, when nothing can fail
  leaves[static_cast<std::size_t>(chosen - waiting_.begin())] = true;
  WaitingMap next = *chosen;
  merge_followers(next, leaves);
  auto leaving = leaves.begin();
  std::erase_if(waiting_, [&](const WaitingMap& waiting) {
    if (!*leaving++) return false;
    bytes_ -= bytes_held(waiting);
    return true;
  });
  for (WaitingMap& other : waiting_) other.trial.steps_behind = false;
  return next;
}

void MapLane::merge_followers(WaitingMap& next, std::vector<bool>& leaves) const {
  const icd::PointCloud2* first = loose_cloud_in(next.map);
  bool open = first != nullptr && !next.alone && next.trial.failures == 0;
  for (std::size_t i = 0; i < waiting_.size() && open; ++i) {
    const WaitingMap& other = waiting_[i];
    if (leaves[i] || other.map.is_grid() || other.map.name != next.map.name) continue;
    if (other.trial.failures > 0) continue;  // what is on trial goes by itself
    const icd::PointCloud2* cloud = loose_cloud_in(other.map);
    open = cloud && !other.alone && mergeable(*first, *cloud) &&
           next.map.data.raw_size + other.map.data.raw_size <= merge_bytes_;
    if (!open) return;
    leaves[i] = true;
    join_parts(next, other);
    next.map = merge(std::move(next.map), other.map);
    first = loose_cloud_in(next.map);
    next.updates.insert(next.updates.end(), other.updates.begin(), other.updates.end());
    next.accepted = std::min(next.accepted, other.accepted);
  }
}

std::vector<std::uint64_t> MapLane::put_back(WaitingMap map) {
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

void MapLane::put_back_apart(WaitingMap map) {
  icd::require(!map.parts.empty() && map.parts.size() == map.updates.size());
  std::deque<WaitingMap> all;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < map.parts.size(); ++i) {
    all.push_back({std::move(map.parts[i]), map.accepted, {map.updates[i]}, {}, true});
    bytes += bytes_held(all.back());
  }
  waiting_.insert(waiting_.begin(), std::move_iterator(all.begin()), std::move_iterator(all.end()));
  bytes_ += bytes;
}

bool MapLane::replaces_any(const icd::MapUpdate& map) const {
  return std::ranges::any_of(waiting_, [&](const WaitingMap& waiting) { return replaces(map, waiting.map); });
}

bool MapLane::is_replaced(const WaitingMap& map) const {
  return std::ranges::any_of(waiting_, [&](const WaitingMap& waiting) { return replaces(waiting, map); });
}

std::size_t MapLane::largest_grid() const {
  std::size_t most = 0;
  for (const WaitingMap& waiting : waiting_) {
    if (waiting.map.is_grid()) most = std::max(most, waiting.map.data.bytes.size());
  }
  return most;
}

}  // namespace adit::lanes
