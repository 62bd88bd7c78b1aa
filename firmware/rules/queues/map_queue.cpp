#include "queues/map_queue.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "icd/require.hpp"
#include "queues/queued_map.hpp"
#include "queues/stitch.hpp"

namespace adit::queues {

bool can_swap(const QueuedMap& one, const QueuedMap& other) {
  if (Sender::from_map(one.map) != Sender::from_map(other.map)) return true;
  return !one.map.is_grid() && !one.is_whole && !other.is_whole;
}

/// The first map that goes ahead is a trial: until it is accepted, no other map goes ahead.
bool Pipelining::can_send(const QueuedMap& next, const PreviousMap& before, Instant now) const {
  if (taken_ < well_ || now > before.arrived + kLate) return false;
  if (before.went_ahead && !tried_) return false;
  if (before.map.trial.failures > 0 || next.trial.failures > 0) return false;
  return can_swap(next, before.map);
}

void Pipelining::on_accepted(bool ahead) {
  taken_ = std::min(taken_ + 1, kMostWell);
  if (!ahead) return;
  tried_ = true;
  well_ = kWell;
}

void Pipelining::on_failed(bool two) {
  taken_ = 0;
  tried_ = false;
  if (two) well_ = std::min(well_ * 2, kMostWell);
}

namespace {

bool is_deferred(const QueuedMap& waiting) {
  return waiting.packing >= PackingRule::Last;
}

SenderQueue::Rest rest_of(const QueuedMap& waiting) {
  return {is_deferred(waiting), waiting.trial.failed.value_or(Instant{}), waiting.accepted};
}

/// The most looks at a canvas for one message: bounds the work.
constexpr std::size_t kMostLooks = 4096;

/// Whether it can replace queued maps at all.
bool can_replace(const QueuedMap& newer) {
  return newer.map.is_grid() || newer.is_whole;
}

}  // namespace

ReplacedMaps SenderQueue::add(QueuedMap added) {
  const auto stays = [&](const QueuedMap& waiting) { return !contains_all_of(added, waiting); };
  const auto first = can_replace(added) ? std::ranges::find_if_not(waiting_, stays) : waiting_.end();
  const auto gone = std::stable_partition(first, waiting_.end(), stays);
  ReplacedMaps replaced;
  for (auto it = gone; it != waiting_.end(); ++it) {
    bytes_ -= memory_bytes(*it);
    queues::replace(added, std::move(*it), replaced);
  }
  waiting_.erase(gone, waiting_.end());
  append(std::move(added));
  return replaced;
}

void SenderQueue::append(QueuedMap added) {
  bytes_ += memory_bytes(added);
  waiting_.push_back(std::move(added));
}

/// An older grid goes first, because its cells must not overwrite newer ones, unless it goes last of all
/// maps. Clouds go in the order of their age.
SenderQueue::Maps::const_iterator SenderQueue::ready(Instant now) const {
  const auto rests = [now](const QueuedMap& waiting) { return waiting.trial.is_resting(now); };
  const auto lets_others_pass = [&](const QueuedMap& waiting) {
    return is_deferred(waiting) ||
           (rests(waiting) && (!waiting.map.is_grid() || waiting.trial.failures >= kInPlace));
  };
  const auto first = std::ranges::find_if_not(waiting_, lets_others_pass);
  return first == waiting_.end() || rests(*first) ? waiting_.end() : first;
}

SenderQueue::Maps::const_iterator SenderQueue::longest_rested() const {
  icd::require(!waiting_.empty());
  if (!waiting_.front().map.is_grid()) return std::ranges::min_element(waiting_, {}, rest_of);
  const auto first = std::ranges::find_if_not(waiting_, is_deferred);
  return first == waiting_.end() ? waiting_.begin() : first;
}

SenderQueue::Rest SenderQueue::resting() const {
  return rest_of(*longest_rested());
}

QueuedMap SenderQueue::pop(Instant now, std::size_t merge_bytes, Canvases& canvases) {
  icd::require(!waiting_.empty());
  const auto may_go = ready(now);
  const auto chosen = may_go == waiting_.end() ? longest_rested() : may_go;
  const auto place = static_cast<std::size_t>(chosen - waiting_.begin());
  // The chosen map and those that go with it. They are removed at the end, when nothing can fail any more.
  std::vector<bool> leaves(waiting_.size());
  leaves[place] = true;
  QueuedMap next = *chosen;
  if (next.map.is_grid()) {
    if (can_join(next)) stitch_followers(next, place, canvases.find(next.map.name), leaves);
    canvases.on_send(next);
  } else if (can_join(next)) {
    merge_followers(next, merge_bytes, leaves);
  }
  auto leaving = leaves.begin();
  std::erase_if(waiting_, [&](const QueuedMap& waiting) {
    if (!*leaving++) return false;
    bytes_ -= memory_bytes(waiting);
    return true;
  });
  return next;
}

void SenderQueue::merge_followers(QueuedMap& next, std::size_t merge_bytes, std::vector<bool>& leaves) const {
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const QueuedMap& other = waiting_[i];
    if (leaves[i]) continue;
    if (other.trial.failures > 0) continue;  // a map on trial goes alone
    const bool fits = can_join(other) && can_merge(next.map, other.map) &&
                      next.map.data.raw_size + other.map.data.raw_size <= merge_bytes;
    if (!fits) return;
    leaves[i] = true;
    join(next, other);
    next.map = merge(std::move(next.map), other.map);
  }
}

/// The indices of the grid at `place` and of those behind it that may be stitched to it. Ends at the first
/// grid that may not, because a grid that goes ahead of it could overlap it.
std::vector<std::size_t> SenderQueue::followers_of(std::size_t place) const {
  const auto& first = std::get<icd::OccupancyGrid>(waiting_[place].map.msg);
  std::vector<std::size_t> places;
  for (std::size_t i = place; i < waiting_.size() && places.size() < kMostStitched; ++i) {
    if (!can_join(waiting_[i])) break;
    if (!cells_in(first, std::get<icd::OccupancyGrid>(waiting_[i].map.msg))) break;
    places.push_back(i);
  }
  return places;
}

/// A map that failed or goes alone may be sent after newer ones. Meanwhile, the others do not use the canvas.
void SenderQueue::stitch_followers(QueuedMap& next, std::size_t place, const Canvas* canvas,
                                   std::vector<bool>& leaves) const {
  const auto grid_at = [this](std::size_t i) { return &std::get<icd::OccupancyGrid>(waiting_[i].map.msg); };
  const auto places = followers_of(place);
  std::vector<Cells> cells;
  cells.reserve(places.size());
  for (const std::size_t i : places) cells.push_back(*cells_in(*grid_at(place), *grid_at(i)));
  const auto first = canvas == nullptr ? std::nullopt : canvas->cells_of(*grid_at(place));
  std::size_t looks = kMostLooks;
  const Stitch found = first && std::ranges::all_of(waiting_, can_join)
                           ? stitch(cells,
                                    [&](const Cells& all, std::span<const Cells> those) {
                                      return canvas->knows(*first, all, those, looks);
                                    })
                           : stitch(cells);
  if (found.which.size() < 2) return;
  std::vector<const icd::OccupancyGrid*> grids;
  grids.reserve(found.which.size());
  for (const std::size_t i : found.which) grids.push_back(grid_at(places[i]));
  const auto whole = stitch_grids(grids);
  if (!whole) return;
  if (found.has_gaps && !(Canvas::can_draw(*whole) && canvas->cells_of(*whole))) return;
  auto bounds = icd::GridBounds::from_grid(*whole);
  for (const std::size_t i : found.which) {
    bounds = icd::joint_bounds(bounds, bounds_of(waiting_[places[i]]));
    if (places[i] == place) continue;
    leaves[places[i]] = true;
    join(next, waiting_[places[i]]);
  }
  next.map.data = {{}, icd::Compression::None, std::size_t{whole->width} * whole->height};
  next.map.msg = *whole;
  next.bounds = bounds;
  next.has_gaps = found.has_gaps;
}

/// The place of a map that was not delivered.
SenderQueue::Maps::const_iterator SenderQueue::place_before_newer(const QueuedMap& back) const {
  return std::ranges::find_if(waiting_, [&](const QueuedMap& waiting) { return is_newer(waiting, back); });
}

ReplacedMaps SenderQueue::put_back(QueuedMap map) {
  map.ground.reset();
  if (map.has_gaps) {
    // At the next try, newer cells may have been sent between its parts.
    const bool may_join_again = can_join(map);
    const auto place = place_before_newer(map);
    insert(place, parts_of(std::move(map), may_join_again));
    return {};
  }
  const auto newer =
      std::ranges::find_if(waiting_, [&](const QueuedMap& waiting) { return replaces(waiting, map); });
  if (newer == waiting_.end()) {
    const std::size_t bytes = memory_bytes(map);
    waiting_.insert(place_before_newer(map), std::move(map));
    bytes_ += bytes;
    return {};
  }
  ReplacedMaps replaced;
  const std::size_t before = memory_bytes(*newer);
  queues::replace(*newer, std::move(map), replaced);
  bytes_ += memory_bytes(*newer) - before;
  return replaced;
}

void SenderQueue::put_back_single(QueuedMap map) {
  const auto place = place_before_newer(map);
  insert(place, parts_of(std::move(map), /*may_join_again=*/false));
}

void SenderQueue::put_back_halves(QueuedMap map) {
  const auto place = place_before_newer(map);
  insert(place, halves_of(std::move(map)));
}

void SenderQueue::insert(Maps::const_iterator place, std::vector<QueuedMap> parts) {
  std::size_t bytes = 0;
  for (const QueuedMap& part : parts) bytes += memory_bytes(part);
  waiting_.insert(place, std::move_iterator(parts.begin()), std::move_iterator(parts.end()));
  bytes_ += bytes;
}

void SenderQueue::inherit(const Trial& trial) {
  for (QueuedMap& each : waiting_) queues::inherit(each.trial, trial);
}

void SenderQueue::step_forward() {
  for (QueuedMap& each : waiting_) each.trial.steps_behind = false;
}

std::optional<CloudPair> SenderQueue::uncompared_clouds() const {
  if (waiting_.size() < 2 || waiting_.back().is_compared) return {};
  const QueuedMap &older = waiting_[waiting_.size() - 2], &newer = waiting_.back();
  if (!can_merge(older.map, newer.map)) return {};
  return CloudPair{.sender = Sender::from_map(newer.map),
                   .older_updates = older.updates,
                   .newer_updates = newer.updates,
                   .older = older.map.data,
                   .newer = newer.map.data,
                   .point_step = std::get<icd::PointCloud2>(newer.map.msg).point_step};
}

void SenderQueue::keep_both(const CloudPair& two) {
  for (QueuedMap& waiting : waiting_) {
    if (waiting.updates == two.newer_updates) waiting.is_compared = true;
  }
}

std::vector<std::uint64_t> SenderQueue::replace(const CloudPair& two) {
  if (waiting_.size() < 2) return {};
  const auto older = waiting_.end() - 2, newer = waiting_.end() - 1;
  const bool are_those =
      older->updates == two.older_updates && older->map.data.raw_size == two.older.raw_size &&
      newer->updates == two.newer_updates && newer->map.data.raw_size == two.newer.raw_size;
  if (!are_those) return {};
  ReplacedMaps replaced;
  bytes_ -= memory_bytes(*older) + memory_bytes(*newer);
  queues::replace(*newer, std::move(*older), replaced);
  bytes_ += memory_bytes(*newer);
  waiting_.erase(older);
  return replaced.numbers;
}

bool SenderQueue::replaces_any(const QueuedMap& map) const {
  return can_replace(map) && std::ranges::any_of(waiting_, [&](const QueuedMap& waiting) {
           return contains_all_of(map, waiting);
         });
}

std::optional<ReplacedMaps> SenderQueue::absorb(const QueuedMap& map) {
  for (QueuedMap& waiting : waiting_) {
    if (auto replaced = queues::absorb(waiting, map)) return replaced;
  }
  return {};
}

bool SenderQueue::can_join_last(const QueuedMap& map) const {
  if (waiting_.empty() || !can_join(waiting_.back())) return false;
  const icd::MapUpdate& last = waiting_.back().map;
  if (map.map.is_grid())
    return cells_in(std::get<icd::OccupancyGrid>(last.msg), std::get<icd::OccupancyGrid>(map.map.msg))
        .has_value();
  return can_merge(last, map.map);
}

std::optional<Instant> SenderQueue::oldest() const {
  const auto oldest = std::ranges::min_element(waiting_, {}, &QueuedMap::accepted);
  return oldest == waiting_.end() ? std::nullopt : std::optional(oldest->accepted);
}

std::size_t SenderQueue::largest_replaceable() const {
  std::size_t most = 0;
  for (const QueuedMap& waiting : waiting_) {
    if (!waiting.map.is_grid() && !waiting.is_whole) continue;
    most = std::max(most, waiting.parts.empty() ? waiting.map.data.bytes.size() : memory_bytes(waiting));
  }
  return most;
}

const SenderQueue* MapQueue::queue_of(const Sender& sender) const {
  const auto found = senders_.find(sender);
  return found == senders_.end() ? nullptr : &found->second.queue;
}

/// The queue of a sender that is about to get a map.
MapQueue::SenderEntry& MapQueue::entry_of(const Sender& sender) {
  SenderEntry& its = senders_[sender];
  if (its.queue.count() == 0) its.turn = turns_.join(its.turn);
  return its;
}

Clouds MapQueue::clouds_of(const Sender& sender) const {
  if (!sender.name) return Clouds::Auto;
  const auto found = clouds_.find(*sender.name);
  return found == clouds_.end() ? Clouds::Auto : found->second;
}

QueuedMap MapQueue::waiting(std::uint64_t number, icd::MapUpdate map, Instant now) const {
  QueuedMap made{.map = std::move(map), .accepted = now, .updates = {number}};
  made.is_whole = !made.map.is_grid() && clouds_of(Sender::from_map(made.map)) == Clouds::Whole;
  return made;
}

ReplacedMaps MapQueue::add(std::uint64_t number, icd::MapUpdate map, Instant now) {
  QueuedMap added = waiting(number, std::move(map), now);
  SenderEntry& its = entry_of(Sender::from_map(added.map));
  inherit(added.trial, its.trial);
  return its.queue.add(std::move(added));
}

void MapQueue::restore(std::uint64_t number, icd::MapUpdate map, Instant now,
                       std::optional<icd::GridBounds> bounds, PackingRule packing) {
  QueuedMap restored = waiting(number, std::move(map), now);
  restored.bounds = bounds;
  restored.packing = packing;
  SenderEntry& its = entry_of(Sender::from_map(restored.map));
  its.queue.append(std::move(restored));
}

/// The sender whose turn it is, among those with a map that may go. If all maps rest, the sender of the map
/// that has rested longest. The end if no map is queued.
MapQueue::Senders::iterator MapQueue::next(Instant now) {
  auto next = senders_.end();
  for (auto each = senders_.begin(); each != senders_.end(); ++each) {
    if (next != senders_.end() && next->second.turn < each->second.turn) continue;
    if (each->second.queue.is_ready(now)) next = each;
  }
  if (next != senders_.end()) return next;
  for (auto each = senders_.begin(); each != senders_.end(); ++each) {
    const SenderQueue& queue = each->second.queue;
    if (queue.count() == 0) continue;
    if (next == senders_.end() || queue.resting() < next->second.queue.resting()) next = each;
  }
  return next;
}

Precision MapQueue::precision_of(const Sender& sender, const SenderQueue& queue) const {
  if (sender.is_grid || !sender.name) return Precision::Exact;
  const auto found = precisions_.find(*sender.name);
  if (found == precisions_.end()) return Precision::Exact;
  return found->second == Precision::Auto ? precision_for(queue.bytes(), holds_) : found->second;
}

std::optional<QueuedMap> MapQueue::pop(Instant now) {
  const auto chosen = next(now);
  if (chosen == senders_.end()) return {};
  SenderEntry& its = chosen->second;
  const Precision precision = precision_of(chosen->first, its.queue);
  const std::size_t most = std::min(merge_bytes_, holds_[static_cast<std::size_t>(precision)]);
  QueuedMap taken = its.queue.pop(now, most, canvases_);
  taken.precision = precision;
  its.turn = turns_.serve(its.turn);
  forget_idle_senders();
  for (auto& [sender, waiting] : senders_) waiting.queue.step_forward();
  return taken;
}

void MapQueue::forget_idle_senders() {
  std::erase_if(senders_, [&](const auto& each) {
    return each.second.queue.count() == 0 && !turns_.is_in_debt(each.second.turn) &&
           !each.second.trial.failed;
  });
}

void MapQueue::on_too_large(const Sender& sender, const Trial& trial) {
  SenderEntry& its = senders_[sender];
  its.trial = trial;
  its.trial.failures = 0;
  its.trial.steps_behind = false;
  its.queue.inherit(its.trial);
}

void MapQueue::on_passed(const Sender& sender) {
  const auto found = senders_.find(sender);
  if (found == senders_.end() || !found->second.trial.failed) return;
  found->second.trial = {};
  found->second.queue.inherit({});
}

void MapQueue::charge(const Sender& sender, std::size_t bytes) {
  icd::require(slot_bytes_ > 0);
  if (bytes <= slot_bytes_) return;
  SenderEntry& its = senders_[sender];
  if (its.turn == Turn{}) its.turn = turns_.join({});
  its.turn = turns_.charge(its.turn, (bytes - 1) / slot_bytes_);
}

ReplacedMaps MapQueue::put_back(QueuedMap map) {
  SenderEntry& its = entry_of(Sender::from_map(map.map));
  return its.queue.put_back(std::move(map));
}

void MapQueue::put_back_single(QueuedMap map) {
  SenderEntry& its = entry_of(Sender::from_map(map.map));
  its.queue.put_back_single(std::move(map));
}

void MapQueue::put_back_halves(QueuedMap map) {
  SenderEntry& its = entry_of(Sender::from_map(map.map));
  its.queue.put_back_halves(std::move(map));
}

std::optional<CloudPair> MapQueue::uncompared_clouds() const {
  for (const auto& [sender, waiting] : senders_) {
    if (sender.is_grid || clouds_of(sender) != Clouds::Auto) continue;
    if (auto two = waiting.queue.uncompared_clouds()) return two;
  }
  return {};
}

std::vector<std::uint64_t> MapQueue::replace(const CloudPair& two) {
  const auto found = senders_.find(two.sender);
  return found == senders_.end() ? std::vector<std::uint64_t>{} : found->second.queue.replace(two);
}

void MapQueue::keep_both(const CloudPair& two) {
  const auto found = senders_.find(two.sender);
  if (found != senders_.end()) found->second.queue.keep_both(two);
}

bool MapQueue::replaces_any(const icd::MapUpdate& map) const {
  const SenderQueue* queue = queue_of(Sender::from_map(map));
  return queue != nullptr && queue->replaces_any(waiting(0, map, {}));
}

bool MapQueue::can_join_last(const icd::MapUpdate& map) const {
  const SenderQueue* queue = queue_of(Sender::from_map(map));
  return queue != nullptr && queue->can_join_last(waiting(0, map, {}));
}

std::optional<ReplacedMaps> MapQueue::absorb(const QueuedMap& map) {
  const auto found = senders_.find(Sender::from_map(map.map));
  return found == senders_.end() ? std::nullopt : found->second.queue.absorb(map);
}

std::size_t MapQueue::count() const {
  std::size_t count = 0;
  for (const auto& [sender, waiting] : senders_) count += waiting.queue.count();
  return count;
}

std::size_t MapQueue::bytes() const {
  std::size_t bytes = 0;
  for (const auto& [sender, waiting] : senders_) bytes += waiting.queue.bytes();
  return bytes;
}

std::size_t MapQueue::count(const Sender& sender) const {
  const SenderQueue* queue = queue_of(sender);
  return queue == nullptr ? 0 : queue->count();
}

std::optional<Instant> MapQueue::oldest(const Sender& sender) const {
  const SenderQueue* queue = queue_of(sender);
  return queue == nullptr ? std::nullopt : queue->oldest();
}

std::size_t MapQueue::largest_replaceable() const {
  std::size_t most = 0;
  for (const auto& [sender, waiting] : senders_) most = std::max(most, waiting.queue.largest_replaceable());
  return most;
}

}  // namespace adit::queues
