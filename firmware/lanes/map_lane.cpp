#include "lanes/map_lane.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace adit::lanes {
namespace {

const icd::OccupancyGrid* grid_in(const WaitingMap& waiting) {
  return std::get_if<icd::OccupancyGrid>(&waiting.map.msg);
}

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

bool replaces(const WaitingMap& newer, const WaitingMap& older) {
  const auto *new_grid = grid_in(newer), *old_grid = grid_in(older);
  return new_grid && old_grid && newer.map.name == older.map.name && covers(*new_grid, *old_grid);
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
}

}  // namespace

bool mergeable(const icd::PointCloud2& a, const icd::PointCloud2& b) {
  return a.fields == b.fields && a.point_step == b.point_step && a.is_bigendian == b.is_bigendian &&
         a.origin.value_or(icd::Pose{}) == b.origin.value_or(icd::Pose{});
}

icd::MapUpdate merge(icd::MapUpdate older, const icd::MapUpdate& newer) {
  older.msg = newer.msg;
  older.data.bytes.append(newer.data.bytes);
  older.data.raw_size += newer.data.raw_size;
  return older;
}

std::vector<std::uint64_t> MapLane::add(std::uint64_t number, icd::MapUpdate map, Instant now) {
  WaitingMap added{std::move(map), now, {number}, {}, false};
  const auto stays = [&](const WaitingMap& waiting) { return !replaces(added, waiting); };
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

std::optional<WaitingMap> MapLane::take() {
  if (waiting_.empty()) return {};
  auto chosen = std::ranges::min_element(waiting_, {}, &WaitingMap::accepted);
  if (chosen->map.is_grid()) {
    // Grids that were made before it go first: sent after it, their old cells would overwrite its new ones.
    chosen = std::ranges::find_if(waiting_, [&](const WaitingMap& waiting) {
      return waiting.map.is_grid() && waiting.map.name == chosen->map.name;
    });
  }
  WaitingMap next = std::move(*chosen);
  waiting_.erase(chosen);
  bytes_ -= bytes_held(next);
  merge_followers(next);
  return next;
}

void MapLane::merge_followers(WaitingMap& next) {
  const icd::PointCloud2* first = loose_cloud_in(next.map);
  bool open = first != nullptr && !next.alone;
  std::erase_if(waiting_, [&](const WaitingMap& other) {
    if (!open || other.map.is_grid() || other.map.name != next.map.name) return false;
    const icd::PointCloud2* cloud = loose_cloud_in(other.map);
    open = cloud && !other.alone && mergeable(*first, *cloud) &&
           next.map.data.raw_size + other.map.data.raw_size <= merge_bytes_;
    if (!open) return false;
    bytes_ -= bytes_held(other);
    join_parts(next, other);
    next.map = merge(std::move(next.map), other.map);
    first = loose_cloud_in(next.map);
    next.updates.insert(next.updates.end(), other.updates.begin(), other.updates.end());
    next.accepted = std::min(next.accepted, other.accepted);
    return true;
  });
}

void MapLane::put_back(WaitingMap map) {
  const auto newer =
      std::ranges::find_if(waiting_, [&](const WaitingMap& waiting) { return replaces(waiting, map); });
  if (newer == waiting_.end()) {
    bytes_ += bytes_held(map);
    waiting_.push_front(std::move(map));
    return;
  }
  bytes_ -= bytes_held(*newer);
  take_over(*newer, std::move(map));
  bytes_ += bytes_held(*newer);
}

void MapLane::put_back_apart(WaitingMap map) {
  for (std::size_t i = map.parts.size(); i-- > 0;) {
    WaitingMap part{std::move(map.parts[i]), map.accepted, {map.updates[i]}, {}, true};
    bytes_ += bytes_held(part);
    waiting_.push_front(std::move(part));
  }
}

std::optional<Instant> MapLane::oldest() const {
  if (waiting_.empty()) return {};
  return std::ranges::min_element(waiting_, {}, &WaitingMap::accepted)->accepted;
}

}  // namespace adit::lanes
