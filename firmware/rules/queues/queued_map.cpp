#include "queues/queued_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <variant>

#include "icd/geometry.hpp"
#include "icd/members.hpp"
#include "icd/require.hpp"

namespace adit::queues {
namespace {

using Action = MapAction;
using Event = MapEvent;
using State = MapState;

constexpr MapTransition kLife[] = {
    {State::Queued, Event::Chosen, State::Packing, Action::Nothing},

    {State::Packing, Event::Packed, State::Packed, Action::Nothing},
    {State::Packing, Event::Recalled, State::Queued, Action::PutBack},
    {State::Packing, Event::NotPacked, State::Queued, Action::PutBack},
    {State::Packing, Event::NotStitched, State::Queued, Action::PutBackApart},
    {State::Packing, Event::SkippedPiece, State::Queued, Action::PutBack},
    {State::Packing, Event::SkippedLast, State::Empty, Action::Forget},
    {State::Packing, Event::Damaged, State::Damaged, Action::SetAside},

    {State::Packed, Event::Sent, State::InFlight, Action::Nothing},
    {State::Packed, Event::Recalled, State::Queued, Action::PutBack},
    {State::Packed, Event::TooLarge, State::Queued, Action::PutBackSmaller},

    {State::InFlight, Event::Accepted, State::Delivered, Action::Forget},
    {State::InFlight, Event::AcceptedPiece, State::Queued, Action::PutBack},
    {State::InFlight, Event::Failed, State::Queued, Action::PutBack},
    {State::InFlight, Event::TooLarge, State::Queued, Action::PutBackSmaller},
    {State::InFlight, Event::RejectedParts, State::Queued, Action::PutBackApart},
    {State::InFlight, Event::Rejected, State::Rejected, Action::Reject},
};

/// The bytes of a point, or of a row of cells.
std::size_t step_of(const QueuedMap& map) {
  if (const auto* cloud = std::get_if<icd::PointCloud2>(&map.map.msg)) return cloud->point_step;
  return std::get<icd::OccupancyGrid>(map.map.msg).width;
}

/// The lower left corner of a row.
icd::Point corner_of_row(const icd::OccupancyGrid& grid, std::size_t row) {
  return icd::Placement{grid.origin}({0, static_cast<double>(row) * grid.resolution, 0});
}

/// The row of `grid` at that point, or its first one.
std::size_t row_at(const icd::OccupancyGrid& grid, const icd::Point& point) {
  const auto& [turn, origin] = icd::Placement{grid.origin};
  const double along_y = turn[0][1] * (point.x - origin.x) + turn[1][1] * (point.y - origin.y) +
                         turn[2][1] * (point.z - origin.z);
  const double row = std::round(along_y / grid.resolution);
  return row >= 0 && row < grid.height ? static_cast<std::size_t>(row) : 0;
}

/// Null for a grid and for packed points.
const icd::PointCloud2* loose_cloud_in(const icd::MapUpdate& map) {
  if (map.data.compression != icd::Compression::None) return nullptr;
  return std::get_if<icd::PointCloud2>(&map.msg);
}

}  // namespace

std::span<const MapTransition> map_life() {
  return kLife;
}

const MapTransition& transition(MapState state, MapEvent event) {
  const auto* const row = std::ranges::find_if(
      kLife, [&](const MapTransition& each) { return each.from == state && each.event == event; });
  icd::require(row != std::end(kLife));
  return *row;
}

bool Cuts::check(std::size_t now_at, std::uint64_t now_delivered) {
  const std::size_t apart = std::max(at, now_at) - std::min(at, now_at);
  if (times == 0 || apart > std::max(at, now_at) / 4) {
    times = 1;
  } else if (now_delivered > delivered) {
    ++times;
  }
  at = now_at;
  delivered = now_delivered;
  return times >= kMost;
}

std::size_t memory_bytes(const QueuedMap& waiting) {
  constexpr std::size_t kFrame = 1024;
  std::size_t bytes = kFrame + waiting.map.data.bytes.size() + waiting.updates.size() * sizeof(std::uint64_t);
  if (const auto* cloud = std::get_if<icd::PointCloud2>(&waiting.map.msg)) {
    for (const auto& field : cloud->fields) bytes += sizeof field + field.name.size();
  } else {
    for (const QueuedMap& part : waiting.parts) bytes += memory_bytes(part);
  }
  return bytes;
}

std::vector<const icd::MapUpdate*> delivered_maps(const QueuedMap& taken) {
  if (!taken.has_gaps) return {&taken.map};
  std::vector<const icd::MapUpdate*> maps;
  maps.reserve(taken.parts.size());
  for (const QueuedMap& part : taken.parts) maps.push_back(&part.map);
  return maps;
}

icd::GridBounds bounds_of(const QueuedMap& grid) {
  return grid.bounds ? *grid.bounds : icd::GridBounds::from_grid(std::get<icd::OccupancyGrid>(grid.map.msg));
}

bool contains_all_of(const QueuedMap& newer, const QueuedMap& older) {
  if (newer.map.name != older.map.name || newer.map.is_grid() != older.map.is_grid()) return false;
  if (!newer.map.is_grid()) return newer.is_whole;
  if (newer.has_gaps) {
    return std::ranges::any_of(newer.parts,
                               [&](const QueuedMap& part) { return contains_all_of(part, older); });
  }
  return icd::covers(std::get<icd::OccupancyGrid>(newer.map.msg), bounds_of(older));
}

bool replaces(const QueuedMap& newer, const QueuedMap& older) {
  return is_newer(newer, older) && contains_all_of(newer, older);
}

/// A clock set back gives many maps one stamp. They are sent again oldest first, so the later one is newer.
bool is_newer(const QueuedMap& waiting, const QueuedMap& back) {
  if (!waiting.again) return true;
  return back.again &&
         std::pair(*waiting.again, waiting.updates.back()) > std::pair(*back.again, back.updates.back());
}

void join(QueuedMap& to, const QueuedMap& from) {
  if (to.parts.empty()) to.parts.push_back(to);
  if (from.parts.empty()) {
    to.parts.push_back(from);
  } else {
    to.parts.insert(to.parts.end(), from.parts.begin(), from.parts.end());
  }
  const auto middle = static_cast<std::ptrdiff_t>(to.updates.size());
  const bool in_order = to.updates.back() < from.updates.front();
  to.updates.insert(to.updates.end(), from.updates.begin(), from.updates.end());
  if (!in_order) std::inplace_merge(to.updates.begin(), to.updates.begin() + middle, to.updates.end());
  to.accepted = std::min(to.accepted, from.accepted);
}

/// A single part may not contain the maps that the whole replaced, so their updates go with the last part.
std::vector<QueuedMap> parts_of(QueuedMap map, bool may_join_again) {
  icd::require(!map.parts.empty());
  std::vector<std::uint64_t> of_parts, others;
  for (QueuedMap& part : map.parts) {
    part.packing = may_join_again ? PackingRule::Any : PackingRule::Alone;
    of_parts.insert(of_parts.end(), part.updates.begin(), part.updates.end());
  }
  std::ranges::sort(of_parts);
  std::ranges::set_difference(map.updates, of_parts, std::back_inserter(others));
  auto& last = map.parts.back().updates;
  last.insert(last.begin(), others.begin(), others.end());
  std::ranges::sort(last);
  return std::move(map.parts);
}

std::vector<QueuedMap> halves_of(QueuedMap map) {
  icd::require(!map.parts.empty());
  const bool is_grid = map.map.is_grid();
  std::vector<QueuedMap> parts = parts_of(std::move(map), /*may_join_again=*/false);
  if (is_grid) return parts;
  const std::size_t middle = (parts.size() + 1) / 2;
  std::vector<QueuedMap> halves;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == 0 || i == middle) {
      halves.push_back(std::move(parts[i]));
      continue;
    }
    join(halves.back(), parts[i]);
    halves.back().map = merge(std::move(halves.back().map), parts[i].map);
  }
  return halves;
}

std::size_t next_size(const QueuedMap& map) {
  const std::size_t all = map.map.data.raw_size;
  if (map.piece.size == 0) return all;
  return std::min({map.piece.size, all - map.piece.at, all - map.piece.delivered});
}

bool can_split(const QueuedMap& map, std::size_t body) {
  constexpr std::size_t kLeastBody = 64'000;
  if (!map.parts.empty()) return true;
  return body >= kLeastBody && next_size(map) > step_of(map);
}

void shrink(QueuedMap& map, std::size_t pieces) {
  const std::size_t step = step_of(map), steps = next_size(map) / step;
  map.piece.size = (steps + pieces - 1) / pieces * step;
  map.packing = std::max(map.packing, PackingRule::Alone);
  map.trial = {};
  map.cuts = {};
}

bool next_piece(QueuedMap& map) {
  if (map.piece.size == 0) return false;
  const std::size_t sent = next_size(map), all = map.map.data.raw_size;
  map.piece.at = (map.piece.at + sent) % all;
  map.piece.delivered += sent;
  map.trial = {};
  map.cuts = {};
  return map.piece.delivered < all;
}

icd::OccupancyGrid rows_of(const QueuedMap& grid) {
  auto rows = std::get<icd::OccupancyGrid>(grid.map.msg);
  if (grid.piece.size == 0) return rows;
  rows.height = static_cast<std::uint32_t>(next_size(grid) / rows.width);
  rows.origin.position = corner_of_row(rows, grid.piece.at / rows.width);
  return rows;
}

bool can_join(const QueuedMap& map) {
  return map.packing == PackingRule::Any && map.trial.failures == 0 && !map.again;
}

void add_own_numbers(std::vector<std::uint64_t>& numbers, const QueuedMap& of) {
  if (of.parts.empty()) numbers.push_back(of.updates.back());
  for (const QueuedMap& part : of.parts) numbers.push_back(part.updates.back());
}

namespace {

/// A stitched grid's parts may be queued singly later, so one of them also takes the bounds.
void adopt_bounds(QueuedMap& to, const QueuedMap& from, ReplacedMaps& replaced) {
  if (!to.map.is_grid()) return;
  to.bounds = icd::joint_bounds(bounds_of(to), bounds_of(from));
  QueuedMap* heir = &to;
  if (!to.parts.empty()) {
    const auto part =
        std::ranges::find_if(to.parts, [&](const QueuedMap& each) { return contains_all_of(each, from); });
    heir = part == to.parts.end() ? &to.parts.back() : &*part;
    heir->bounds = icd::joint_bounds(bounds_of(*heir), bounds_of(from));
  }
  if (heir->bounds->is_larger_than(std::get<icd::OccupancyGrid>(heir->map.msg)))
    replaced.bounds = {heir->updates.back(), *heir->bounds};
}

}  // namespace

std::optional<ReplacedMaps> absorb(QueuedMap& to, const QueuedMap& from) {
  if (!replaces(to, from)) return {};
  ReplacedMaps replaced;
  adopt_bounds(to, from, replaced);
  return replaced;
}

void replace(QueuedMap& to, QueuedMap from, ReplacedMaps& replaced) {
  add_own_numbers(replaced.numbers, from);
  adopt_bounds(to, from, replaced);
  if (to.map.is_grid() && to.piece.size == 0 && from.piece.at > 0) {
    const auto& grid = std::get<icd::OccupancyGrid>(to.map.msg);
    const auto& older = std::get<icd::OccupancyGrid>(from.map.msg);
    to.piece.at = grid.width * row_at(grid, corner_of_row(older, from.piece.at / older.width));
  }
  const auto middle = static_cast<std::ptrdiff_t>(from.updates.size());
  from.updates.insert(from.updates.end(), to.updates.begin(), to.updates.end());
  to.updates = std::move(from.updates);
  std::inplace_merge(to.updates.begin(), to.updates.begin() + middle, to.updates.end());
  to.accepted = std::min(to.accepted, from.accepted);
  inherit(to.trial, from.trial);  // with its place
}

void inherit(Trial& to, const Trial& from) {
  if (to.failures > 0) return;
  to = from;
  to.strikes = std::min(to.strikes, Blame::kMostStrikes - 2);
  to.proofs = std::min(to.proofs, Blame::kMostStrikes - 2);
}

bool mergeable(const icd::PointCloud2& a, const icd::PointCloud2& b) {
  static_assert(icd::count_of_members<icd::PointCloud2>() == 5, "compare each member but the header");
  return a.fields == b.fields && a.point_step == b.point_step && a.is_bigendian == b.is_bigendian &&
         a.origin.value_or(icd::Pose{}) == b.origin.value_or(icd::Pose{});
}

bool can_merge(const icd::MapUpdate& a, const icd::MapUpdate& b) {
  const auto *const one = loose_cloud_in(a), *const other = loose_cloud_in(b);
  return one != nullptr && other != nullptr && mergeable(*one, *other);
}

icd::MapUpdate merge(icd::MapUpdate older, const icd::MapUpdate& newer) {
  icd::require(older.name == newer.name && !older.is_grid() && !newer.is_grid());
  older.msg = newer.msg;
  older.data.bytes.append(newer.data.bytes);
  older.data.raw_size += newer.data.raw_size;
  return older;
}

}  // namespace adit::queues
