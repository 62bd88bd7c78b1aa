#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "icd/map_update.hpp"
#include "lanes/blame.hpp"
#include "lanes/ground.hpp"
#include "lanes/precision.hpp"

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
  /// What was merged or stitched into it, in the order they were made; else empty. The cells of a stitched
  /// grid are in its parts alone, until it is packed.
  std::vector<WaitingMap> parts{};
  bool alone = false;  // not to be merged or stitched with others
  /// Of a stitched grid: its parts do not fill it, and the cells between them are those of `ground`.
  bool has_gaps = false;
  /// Of a grid that was taken to be sent: what lies under it. Null: it is not drawn (Canvases).
  std::shared_ptr<const Ground> ground{};
  /// Of a cloud: it says all that those said which came before it.
  bool is_whole = false;
  /// Of a cloud: it is known whether it has all points of the one before it.
  bool is_compared = false;
  /// Of a cloud that was taken to be sent: how far it may be rounded; not Auto.
  Precision precision = Precision::Exact;
  Trial trial{};  // where the Command Post's handler failed at it
  /// Only of a map that was rejected and is sent again by hand: the stamp that it had. By it the map is
  /// older than all that were never rejected, and is told from others that are sent again.
  std::optional<icd::Stamp> again{};
};

/// The maps of which the Command Post has all once it took `taken`: that one; of one with gaps its parts, for
/// what is in a gap is no news of that place.
std::vector<const icd::MapUpdate*> said_by(const WaitingMap& taken);
/// Whether `newer`, which has just come, says all that `older` said: a grid that covers it (of one with gaps
/// a part of it), or a whole cloud.
bool says_all_of(const WaitingMap& newer, const WaitingMap& older);
/// Whether `newer`, which is under way or waits, is newer and says all that `older` said, which comes back.
bool replaces(const WaitingMap& newer, const WaitingMap& older);

/// Whether `waiting` is newer than `back`, which comes back to it.
bool is_newer(const WaitingMap& waiting, const WaitingMap& back);

/// What it keeps in memory beside its data: itself, its fields, and what allocators add.
std::size_t bytes_held(const WaitingMap& waiting);

/// Adds the numbers of the maps that would be sent with it: not of those that these have replaced.
void add_own_numbers(std::vector<std::uint64_t>& numbers, const WaitingMap& of);

/// `from`, which `to` replaces, is older news: its updates become `to`'s as well, and its age counts.
void take_over(WaitingMap& to, WaitingMap from);

/// `from` is sent within `to`, which stands for its updates from now on, and keeps both as its parts: their
/// bytes are shared, so that this costs next to nothing.
void join(WaitingMap& to, const WaitingMap& from);

/// Takes `map` apart: each part with its updates, to be joined again or sent by itself. Requires parts.
std::vector<WaitingMap> parts_of(WaitingMap map, bool may_join_again);

/// Whether it may be sent within another one, or another one within it.
bool may_join(const WaitingMap& map);

/// The cloud whose points can be joined to others; null for a grid and for packed points.
const icd::PointCloud2* loose_cloud_in(const icd::MapUpdate& map);

}  // namespace adit::lanes
