#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "icd/map_update.hpp"
#include "lanes/blame.hpp"

namespace adit::lanes {

/// ICD 6.3.1 and promise 2: whether `newer` says all that `older` said, so that `older` need not be sent: the
/// same lattice (resolution, orientation and height alike, origins a whole number of cells apart, to a
/// thousandth of a cell) and older's extent within newer's. Reflexive and transitive.
bool covers(const icd::OccupancyGrid& newer, const icd::OccupancyGrid& older);

/// Whether the points of both can be in one message: fields, point_step, byte order and origin are the same.
bool mergeable(const icd::PointCloud2& a, const icd::PointCloud2& b);

/// Older's points and then newer's, in one update with newer's header. Requires mergeable clouds of one name
/// with uncompressed data. Shares their bytes.
icd::MapUpdate merge(icd::MapUpdate older, const icd::MapUpdate& newer);

/// A map that waits, and which accepted updates it stands for (itself, what it replaced, what was merged into
/// it).
struct WaitingMap {
  icd::MapUpdate map;
  Instant accepted;                    // when the oldest news in it was accepted
  std::vector<std::uint64_t> updates;  // their numbers, oldest first
  std::vector<icd::MapUpdate>
      parts{};         // the clouds that were merged into it, one for each update; else empty
  bool alone = false;  // not to be merged with others
  Trial trial{};       // where the Command Post's handler failed at it
  /// Only of a map that was set aside and is sent again by hand: the stamp that it had. By it the map is
  /// older than all that were never set aside, and is told from others that are sent again.
  std::optional<icd::Stamp> again{};
};

/// Whether `newer`, which is under way or waits, is newer and says all that `older` said, which comes back.
bool replaces(const WaitingMap& newer, const WaitingMap& older);

/// The maps that wait for the Command Post.
///
/// The oldest news goes first. A newer grid of the same name replaces one that it covers, and inherits its
/// age. Grids of that name that it does not cover still go ahead of it, so that old cells are never sent
/// after newer ones. Clouds are kept in order; take() merges clouds of one name that follow each other while
/// more than one map waits. Nothing else is ever dropped.
///
/// A map on trial (Blame) lets others go first while it rests. A grid on trial holds back the later grids of
/// its name for its first kInPlace failures, counting those of grids that it replaced; then they go ahead of
/// it, to see whether they pass.
///
/// If take() or a function that puts back throws for lack of memory, everything waits as before.
class MapLane {
 public:
  /// Most bytes of points that take() merges into one message.
  explicit MapLane(std::size_t merge_bytes) : merge_bytes_(merge_bytes) {}

  void merge_at_most(std::size_t bytes) { merge_bytes_ = bytes; }

  /// The numbers of the updates whose maps `map` replaced; it stands for them from now on. No number is given
  /// twice.
  std::vector<std::uint64_t> add(std::uint64_t number, icd::MapUpdate map, Instant now);

  static constexpr int kInPlace = 3;

  /// The next to be sent, taken out of the lane. Without `now`, nothing rests.
  std::optional<WaitingMap> take(Instant now = Instant::max());

  /// Puts back a map that could not be sent, or is sent again: first in line, but behind older ones that are
  /// sent again. If a newer grid that waits covers it, that one takes its updates and its age instead. Gives
  /// the numbers of those that are no longer needed, as add() does.
  std::vector<std::uint64_t> put_back(WaitingMap map);

  /// Puts back the parts of a merged cloud, first in line and never to be merged again, so that the part that
  /// the Command Post cannot take is found, and the others arrive. Requires parts.
  void put_back_apart(WaitingMap map);

  /// Whether add() would replace one that waits.
  bool replaces_any(const icd::MapUpdate& map) const;
  /// Whether put_back() would find a newer grid that covers it.
  bool is_replaced(const WaitingMap& map) const;

  std::size_t count() const { return waiting_.size(); }
  std::size_t bytes() const { return bytes_; }  // of memory held by all that wait
  std::size_t largest_grid() const;             // bytes of its data: what one that replaces it may need
  const std::deque<WaitingMap>& waiting() const { return waiting_; }  // in the order they were made

 private:
  using Place = std::deque<WaitingMap>::iterator;
  Place choose(Instant now);
  /// Adds to `leaves`, in the order of waiting_, what it merged.
  void merge_followers(WaitingMap& next, std::vector<bool>& leaves) const;

  std::deque<WaitingMap> waiting_;
  std::size_t merge_bytes_;
  std::size_t bytes_ = 0;
};

}  // namespace adit::lanes
