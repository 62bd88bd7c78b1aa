#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "icd/grid_bounds.hpp"
#include "icd/mapping.hpp"
#include "queues/blame.hpp"
#include "queues/clouds.hpp"
#include "queues/lattice.hpp"

namespace adit::queues {

/// A sender in Turns: the maps of one robot and one kind.
struct Sender {
  std::optional<icd::RobotName> name;  // absent: merged maps of all robots
  bool is_grid = false;
  static Sender from_map(const icd::MapUpdate& map) { return {map.name, map.is_grid()}; }
  friend auto operator<=>(const Sender&, const Sender&) = default;
};

/// Whether one message can have the points of both: fields, point_step, byte order and origin are the same.
bool mergeable(const icd::PointCloud2& a, const icd::PointCloud2& b);
/// The same of two maps. False for grids and for packed points.
bool can_merge(const icd::MapUpdate& a, const icd::MapUpdate& b);

/// older's points, then newer's, with newer's header. Shares their bytes. Requires can_merge() and one name.
icd::MapUpdate merge(icd::MapUpdate older, const icd::MapUpdate& newer);

/// A large message got no answer, or 400 with a page, so often in a row. `at`: the bytes of it that had left
/// the last time. `delivered`: the messages that had been delivered then.
struct Cuts {
  static constexpr std::size_t kLeastBody = 256'000;  // smaller messages are never too large without a 413
  static constexpr int kMost = 3;
  int times = 0;
  std::size_t at = 0;
  std::uint64_t delivered = 0;

  /// True if its size seems to be the reason: it happened kMost times at about the same byte, and other
  /// messages were delivered each time since the last one.
  bool check(std::size_t now_at, std::uint64_t now_delivered);
};

/// The points of a cloud or the rows of a grid that are sent next, if the map is too large for one message,
/// in bytes of its uncompressed data. Size 0: the whole map.
struct Piece {
  std::size_t at = 0, size = 0;
  std::size_t delivered = 0;  // by earlier pieces. After the last row of a grid follows its first one
};

/// How a map may be packed.
enum class PackingRule : std::uint8_t {
  Any,         // it may be merged or stitched
  Alone,       // not merged or stitched
  Last,        // alone, after all other maps
  LastAsItIs,  // the same, and sent as it arrived
};

/// A queued map and the accepted updates that it stands for: its own, replaced and merged ones.
struct QueuedMap {
  icd::MapUpdate map;
  Instant accepted;                    // when the oldest of `updates` was accepted
  std::vector<std::uint64_t> updates;  // numbers, oldest first
  /// The maps that were merged or stitched into it, in the order in which they were made; else empty. Until a
  /// stitched grid is packed, only its parts have its cells.
  std::vector<QueuedMap> parts{};
  PackingRule packing = PackingRule::Any;
  /// A stitched grid whose parts do not fill it. The cells between them are those of `ground`.
  bool has_gaps = false;
  /// For a grid that is being sent: the cells sent before. Null: it is not drawn (Canvases).
  std::shared_ptr<const Ground> ground{};
  /// For a cloud: it contains all earlier ones.
  bool is_whole = false;
  /// For a cloud: it was compared with the previous one.
  bool is_compared = false;
  /// For a cloud that is being sent: how far it may be rounded; not Auto.
  Precision precision = Precision::Exact;
  Trial trial{};  // its failures at the Command Post
  Cuts cuts{};
  Piece piece{};
  /// The bounds of a grid and of all that it replaced, along its own axes; nothing if it replaced none.
  std::optional<icd::GridBounds> bounds{};
  /// Only for a rejected map that the operator sends again: its original stamp. It orders the map before all
  /// maps that were never rejected, and identifies it.
  std::optional<icd::Stamp> again{};
};

enum class MapState : std::uint8_t {
  Queued,
  Packing,
  Packed,    // ready to be sent
  InFlight,  // sent, not yet answered
  Delivered,
  Rejected,
  Damaged,  // its file cannot be read any more
  Empty,    // it has no valid point
};

enum class MapEvent : std::uint8_t {
  Chosen,
  Packed,
  NotPacked,     // the worker failed
  NotStitched,   // its parts do not fit together
  Damaged,       // the data in its file, or in that of a part
  SkippedPiece,  // no valid point in this piece; another piece follows
  SkippedLast,   // the same; no piece follows
  Recalled,      // the map before it failed, or the Command Post or the run is another one
  TooLarge,      // for one message
  Sent,
  AcceptedPiece,  // 2xx; another piece follows
  Accepted,       // 2xx
  Failed,         // to be retried, or pieces before it may be lost
  RejectedParts,  // a merged or stitched map
  Rejected,
};

/// The effect of a step on the queue and on the stored map.
enum class MapAction : std::uint8_t {
  Nothing,
  PutBack,         // it is queued again
  PutBackApart,    // its parts are, each by itself
  PutBackSmaller,  // its halves are, or it is with smaller pieces
  Forget,          // delete its file
  Reject,          // the rejected messages get it, then its file is deleted
  SetAside,        // rename its file; its other parts are queued again
};

struct MapTransition {
  MapState from;
  MapEvent event;
  MapState to;
  MapAction action;
};

/// All transitions.
std::span<const MapTransition> map_life();
/// Requires that the event can happen in that state.
const MapTransition& transition(MapState state, MapEvent event);

/// The maps delivered if `taken` is accepted: itself, or the parts of a map with gaps, which have no news.
std::vector<const icd::MapUpdate*> delivered_maps(const QueuedMap& taken);
/// The bounds of a grid and of all that it replaced.
icd::GridBounds bounds_of(const QueuedMap& grid);
/// Whether `newer`, which was just accepted, contains all of `older` and of what that replaced: it is a grid
/// that covers it (icd::covers()), has a part that covers it (if it has gaps), or is a whole cloud.
bool contains_all_of(const QueuedMap& newer, const QueuedMap& older);
/// The same for a retry: `newer`, queued or in flight, must be newer than `older`, which was not delivered.
bool replaces(const QueuedMap& newer, const QueuedMap& older);

/// Whether `waiting` is newer than `back`, which was not delivered.
bool is_newer(const QueuedMap& waiting, const QueuedMap& back);

/// The bytes of memory that it takes, without its data: itself, its fields, and the allocator's overhead.
std::size_t memory_bytes(const QueuedMap& waiting);

/// Appends the numbers of the maps that are sent with it, without those that they replaced.
void add_own_numbers(std::vector<std::uint64_t>& numbers, const QueuedMap& of);

/// Maps that are no longer needed, because a newer one stands for them.
struct ReplacedMaps {
  std::vector<std::uint64_t> numbers;  // of their updates
  /// The newer map has larger bounds than its own: its number, and the bounds. Store them before the older
  /// maps are deleted, so that a later process knows them.
  std::optional<std::pair<std::uint64_t, icd::GridBounds>> bounds{};
};

/// `to` stands for `from`, which is not queued. Nothing: `to` is older, or does not contain it.
std::optional<ReplacedMaps> absorb(QueuedMap& to, const QueuedMap& from);

/// `to` replaces `from`, which is added to `replaced`, and takes its updates, age and bounds. If `from` is a
/// grid in pieces, `to` begins with the rows that `from` would have sent next, so that each row is sent even
/// if grids are replaced faster than their pieces are sent.
void replace(QueuedMap& to, QueuedMap from, ReplacedMaps& replaced);

/// Unless `to` has failed itself, it takes the strikes and the rest of `from`, but never the last two
/// strikes: it must fail itself to be rejected.
void inherit(Trial& to, const Trial& from);

/// Merges `from` into `to`, which takes its updates and keeps both as parts. The parts share their bytes.
void join(QueuedMap& to, const QueuedMap& from);

/// The parts of `map`, each with its updates. `may_join_again`: they may be merged again. Requires parts.
std::vector<QueuedMap> parts_of(QueuedMap map, bool may_join_again);

/// Merged clouds as two maps that are not merged again, or the parts of a stitched grid. Requires parts.
std::vector<QueuedMap> halves_of(QueuedMap map);

/// The rows of a grid that are sent next, as a grid of their own.
icd::OccupancyGrid rows_of(const QueuedMap& grid);
/// The bytes of data that it sends next.
std::size_t next_size(const QueuedMap& map);
/// Whether halves_of() or shrink() can make smaller messages of it, if its message has so many bytes.
bool can_split(const QueuedMap& map, std::size_t body);
/// The next pieces of the map have an equal share of its next points or rows each, and have not failed yet.
void shrink(QueuedMap& map, std::size_t pieces);
/// The next piece was delivered. Returns whether there is another one.
bool next_piece(QueuedMap& map);

/// Whether it may be merged or stitched with others.
bool can_join(const QueuedMap& map);

}  // namespace adit::queues
