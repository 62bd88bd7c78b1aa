#pragma once

#include <algorithm>
#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"
#include "queues/canvases.hpp"
#include "queues/clouds.hpp"
#include "queues/queued_map.hpp"

namespace adit::queues {

/// Decides whether the next map may be sent before the Command Post has answered the previous one, so that
/// the link is not idle meanwhile. At most two maps are in flight, and the first one has arrived.
/// A map goes ahead if all of this holds:
/// - The order of the two does not matter, even if the first one fails and is retried after the second one:
///   they are maps of different senders, or clouds of one sender that are parts.
/// - The Command Post accepted the last kWell maps, and is not late by kLate. Else more maps would not help.
/// - The previous map has never failed.
/// After each failure with two maps in flight, twice as many maps have to be accepted in a row. A Command
/// Post that cannot handle two maps therefore mostly gets one at a time.
class Pipelining {
 public:
  static constexpr int kWell = 2, kMostWell = 128;
  static constexpr std::chrono::milliseconds kLate{500};

  /// The previous map, and when it had arrived.
  struct PreviousMap {
    const QueuedMap& map;
    Instant arrived;
    bool went_ahead;
  };
  bool can_send(const QueuedMap& next, const PreviousMap& before, Instant now) const;

  /// A map was accepted. `ahead`: it was sent before the previous map was answered.
  void on_accepted(bool ahead);
  /// A map was not accepted, for any reason. `two`: two maps were in flight.
  void on_failed(bool two);

 private:
  int taken_ = 0;       // in a row
  int well_ = kWell;    // as many are needed
  bool tried_ = false;  // a map that went ahead is among them
};

/// Whether a Command Post may accept the two maps in either order.
bool can_swap(const QueuedMap& one, const QueuedMap& other);

/// When a sender's next message is sent: by round, and within a round by place. The smaller turn goes first.
struct Turn {
  std::uint64_t round = 0, place = 0;
  friend auto operator<=>(const Turn&, const Turn&) = default;
};

/// Deficit round robin (Shreedhar and Varghese, 1995), paid afterwards: a message costs its sender one round
/// for each slot that it used. Of N senders with queued messages, each is served once before any is served
/// twice. A sender without messages saves no turns, and still pays when it comes back.
class Turns {
 public:
  /// The most that one message costs, in slots.
  static constexpr std::uint64_t kMostSlots = 64;

  /// The turn of a sender whose queue was empty, behind all. `last`: its last result of serve() or charge().
  Turn join(Turn last) { return {std::max(last.round, round_ + 1), ++places_}; }
  /// Serves `turn`, and returns the sender's next turn.
  Turn serve(Turn turn) {
    round_ = std::max(round_, turn.round);
    return {round_ + 1, ++places_};
  }
  /// The sender's next turn if its message used `slots` more than one slot.
  Turn charge(Turn next, std::uint64_t slots) const {
    return {std::min(next.round + std::min(slots, kMostSlots), round_ + 1 + kMostSlots), next.place};
  }
  /// Whether a sender with an empty queue still has to pay. If not, it can be forgotten.
  bool is_in_debt(Turn turn) const { return turn.round > round_ + 1; }

 private:
  std::uint64_t round_ = 0;  // the present one
  std::uint64_t places_ = 0;
};

/// Two successive queued clouds of one sender with the same fields, byte order and origin.
struct CloudPair {
  Sender sender;
  std::vector<std::uint64_t> older_updates, newer_updates;  // QueuedMap::updates, to find them again
  icd::MapData older, newer;                                // not compressed
  std::uint32_t point_step = 0;                             // bytes
};

/// The queued maps of one sender, in the order in which they were made. MapQueue describes the functions.
class SenderQueue {
 public:
  /// After so many failures of a grid, later grids of its name go ahead of it.
  static constexpr int kInPlace = 3;

  ReplacedMaps add(QueuedMap added);
  void append(QueuedMap added);  // replaces no map
  /// Whether a map may be sent now. A map that rests may not, nor a grid behind a grid that rests.
  bool is_ready(Instant now) const { return ready(now) != waiting_.end(); }
  /// Orders resting maps: whether it goes last, when it failed, and when it was accepted.
  using Rest = std::tuple<bool, Instant, Instant>;
  /// Of the map that has rested longest. Requires a map.
  Rest resting() const;
  /// The oldest map that may be sent. If there is none, the map that has rested longest. Requires a map.
  QueuedMap pop(Instant now, std::size_t merge_bytes, Canvases& canvases);
  ReplacedMaps put_back(QueuedMap map);
  void put_back_single(QueuedMap map);
  void put_back_halves(QueuedMap map);
  void restart_pieces() {
    for (QueuedMap& each : waiting_) each.piece = {};
  }
  void inherit(const Trial& trial);  // by the maps that have not failed themselves
  void step_forward();               // clears Trial::steps_behind of all maps

  std::vector<std::uint64_t> replace(const CloudPair& two);
  /// The last two clouds, if they have not been compared yet.
  std::optional<CloudPair> uncompared_clouds() const;
  void keep_both(const CloudPair& two);

  bool replaces_any(const QueuedMap& map) const;
  std::optional<ReplacedMaps> absorb(const QueuedMap& map);
  bool can_join_last(const QueuedMap& map) const;
  /// When the oldest queued map was accepted, or nothing.
  std::optional<Instant> oldest() const;
  std::size_t count() const { return waiting_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t largest_replaceable() const;

 private:
  using Maps = std::deque<QueuedMap>;
  Maps::const_iterator ready(Instant now) const;
  Maps::const_iterator longest_rested() const;
  Maps::const_iterator place_before_newer(const QueuedMap& back) const;
  /// Each marks in `leaves`, which has the order of waiting_, the maps that go with `next`.
  void merge_followers(QueuedMap& next, std::size_t merge_bytes, std::vector<bool>& leaves) const;
  void stitch_followers(QueuedMap& next, std::size_t place, const Canvas* canvas,
                        std::vector<bool>& leaves) const;
  void insert(Maps::const_iterator place, std::vector<QueuedMap> parts);
  std::vector<std::size_t> followers_of(std::size_t place) const;

  Maps waiting_;
  std::size_t bytes_ = 0;
};

/// The queued maps.
/// Turns: a sender is a robot's maps of one kind. If N senders have queued maps, each is served within N
/// messages (Turns). Each try is a turn, whatever its outcome.
///
/// Order and replacement within a sender:
/// - The oldest map goes first.
/// - A newer grid replaces an older grid that it covers, with all that the older one replaced
///   (icd::covers()), and inherits its age. Grids of that name that it does not cover go ahead of it, so that
///   old cells are never sent after newer ones.
/// - pop() stitches grids of one lattice that fill a rectangle. It fills gaps between them with the cells
///   that were last sent there, if these are known (stitch.hpp, canvases.hpp).
/// - Clouds stay in order. pop() merges clouds that follow each other.
/// - A cloud replaces all earlier ones if the robot's clouds are Clouds::Whole. With Clouds::Auto it replaces
///   the previous one if a comparison shows that it has all its points (uncompared_clouds(), replace()).
/// - No other map is dropped.
/// - A map with PackingRule::Last is taken only if all others rest or are gone.
///
/// Result for the grids of one name and lattice: a Command Post that overwrites cells ends with the newest
/// posted value in each cell, unknown included. One that overlays (unknown overwrites nothing) ends with the
/// newest value wherever it is known. If lattices differ, a replaced grid may lack half a cell at its edge.
///
/// A map on trial (Blame) lets others go first while it rests. A grid on trial holds back later grids of its
/// name for its first kInPlace failures, including those of grids that it replaced. Then they go ahead.
class MapQueue {
 public:
  /// `merge_bytes`: the most bytes of points that pop() merges into one message.
  explicit MapQueue(std::size_t merge_bytes) : merge_bytes_(merge_bytes) {}

  void merge_at_most(std::size_t bytes) { merge_bytes_ = bytes; }
  /// The bytes that the link carries between two messages; at least 1.
  void set_slot_bytes(std::size_t bytes) { slot_bytes_ = bytes; }

  /// Applies to clouds that are added from now on. Robots that are not named have Clouds::Auto.
  void set_cloud_modes(std::map<icd::RobotName, Clouds> clouds) { clouds_ = std::move(clouds); }

  Clouds clouds_of(const Sender& sender) const;

  /// Applies to clouds that are taken from now on. Robots that are not named have Precision::Exact.
  void set_precisions(std::map<icd::RobotName, Precision> precisions) { precisions_ = std::move(precisions); }
  /// The bytes of points that fit into one message; pop() merges no more. With Precision::Auto, pop()
  /// chooses the finest precision at which all queued clouds of the robot fit.
  void set_message_points(const PointsAt& points) { holds_ = points; }

  /// Adds a map, which stands from now on for the maps that it replaced. A number is used once.
  ReplacedMaps add(std::uint64_t number, icd::MapUpdate map, Instant now);

  /// Adds a map that was queued before a restart, with its stored bounds; call in the order of the numbers.
  /// It replaces no other map, because comparisons would delay the start.
  void restore(std::uint64_t number, icd::MapUpdate map, Instant now,
               std::optional<icd::GridBounds> bounds = {}, PackingRule packing = PackingRule::Any);

  /// Takes the next map to be sent out of the queue. Without `now`, maps that rest are taken as well.
  std::optional<QueuedMap> pop(Instant now = Instant::max());

  /// The sent cells of each robot's grids. The caller reports there how a grid was drawn.
  Canvases& canvases() { return canvases_; }

  /// A map of `sender` was too large and has failed as `trial` says. Until one of its maps is accepted
  /// (on_passed()), its queued maps and later ones rest as long and begin with its strikes (inherit()).
  void on_too_large(const Sender& sender, const Trial& trial);
  void on_passed(const Sender& sender);

  /// A message of `sender` used `bytes` of the link. The sender pays for the part beyond one slot with turns.
  void charge(const Sender& sender, std::size_t bytes);

  /// Queues a map again that was not delivered, or that the operator sends again: as the sender's first map,
  /// but behind older ones that are sent again. If a newer queued grid covers it, that grid inherits its
  /// updates and age instead, and the map is in the result.
  ReplacedMaps put_back(QueuedMap map);

  /// Queues the parts of a merged or stitched map again, each by itself, as the sender's first maps. They are
  /// not joined again, so that only the part that the Command Post rejects fails. Requires parts.
  void put_back_single(QueuedMap map);
  /// The same for a map that was too large: the halves of merged clouds, or the parts of a stitched grid.
  void put_back_halves(QueuedMap map);

  /// The Command Post may lack the pieces that were delivered: maps in pieces begin with their first one.
  void restart_pieces() {
    for (auto& [sender, waiting] : senders_) waiting.queue.restart_pieces();
  }

  /// Two successive clouds not compared yet, or nothing. Call replace() or keep_both() with the outcome.
  std::optional<CloudPair> uncompared_clouds() const;
  /// The newer cloud has all points of the older one and replaces it, if both are still queued unchanged.
  /// Returns the numbers of the updates whose maps are no longer needed.
  std::vector<std::uint64_t> replace(const CloudPair& two);
  /// The newer cloud lacks points of the older one, or the comparison failed.
  void keep_both(const CloudPair& two);

  /// Whether add() would replace a queued map.
  bool replaces_any(const icd::MapUpdate& map) const;
  /// Whether pop() could merge or stitch it with the last queued map of its sender.
  bool can_join_last(const icd::MapUpdate& map) const;
  /// If a newer queued grid covers `map`, which is not queued, it stands for `map` from now on.
  std::optional<ReplacedMaps> absorb(const QueuedMap& map);

  std::size_t count() const;
  std::size_t count(const Sender& sender) const;
  /// When the oldest queued map of that sender was accepted, or nothing.
  std::optional<Instant> oldest(const Sender& sender) const;
  std::size_t bytes() const;  // of memory, held by all queued maps
  /// The size of the largest queued grid or whole cloud, in bytes: a map that replaces it may need as much.
  std::size_t largest_replaceable() const;
  /// The number of known senders: those with queued maps, and those that still pay with turns.
  std::size_t senders() const { return senders_.size(); }

 private:
  struct SenderEntry {
    SenderQueue queue;
    Turn turn;
    Trial trial{};  // of its last map, if that was too large
  };
  using Senders = std::map<Sender, SenderEntry>;

  Senders::iterator next(Instant now);
  SenderEntry& entry_of(const Sender& sender);
  void forget_idle_senders();
  const SenderQueue* queue_of(const Sender& sender) const;
  QueuedMap waiting(std::uint64_t number, icd::MapUpdate map, Instant now) const;
  Precision precision_of(const Sender& sender, const SenderQueue& queue) const;

  Senders senders_;
  std::map<icd::RobotName, Clouds> clouds_;
  std::map<icd::RobotName, Precision> precisions_;
  PointsAt holds_ = kAnyPoints;
  Turns turns_;
  Canvases canvases_;
  std::size_t merge_bytes_;
  std::size_t slot_bytes_ = 8u << 20;
};

}  // namespace adit::queues
