#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "lanes/canvases.hpp"
#include "lanes/clouds.hpp"
#include "lanes/map_queue.hpp"
#include "lanes/precision.hpp"
#include "lanes/sender.hpp"
#include "lanes/successive.hpp"
#include "lanes/turns.hpp"
#include "lanes/waiting_map.hpp"

namespace adit::lanes {

/// The maps that wait for the Command Post.
///
/// Each sender, a robot's maps of one kind, has its turn (Turns): if N of them wait, each is served within N
/// messages, whatever one of them does. A try is a turn, whatever became of it.
///
/// Within a sender the oldest news goes first. A newer grid replaces one that it covers, and inherits its
/// age. Grids of that name that it does not cover still go ahead of it, so that old cells are never sent
/// after newer ones. Clouds are kept in order; take() merges clouds that follow each other, and stitches
/// grids of one lattice that fill a rectangle, with what was last sent in the gaps between them where that is
/// known (stitch.hpp, canvases.hpp). A cloud replaces those before it where its
/// robot's clouds are said to be whole (Clouds); where nothing is said, the one before it, once somebody has
/// seen that it has all its points (to_compare(), replace()). Nothing else is ever dropped.
///
/// So what a Command Post has in the end, of the grids of one name and lattice, is in each cell the newest
/// value that was posted for it, unknown included, where it overwrites cells by what it is sent. Where it
/// overlays (unknown overwrites nothing), that is so of each cell whose newest value is known; of the others
/// it has a value that was posted, or none.
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
  /// Bytes of a message that the link carries in the time between two messages; at least 1.
  void a_slot_carries(std::size_t bytes) { slot_bytes_ = bytes; }

  /// Of the robots that are not named, Clouds::Auto. Holds for clouds that are added from now on.
  void clouds_are(std::map<icd::RobotName, Clouds> clouds) { clouds_ = std::move(clouds); }

  Clouds clouds_of(const Sender& sender) const;

  /// Of the robots that are not named, Precision::Exact. Holds for clouds that are taken from now on.
  void precisions_are(std::map<icd::RobotName, Precision> precisions) { precisions_ = std::move(precisions); }
  /// What the link carries of points in one message: no more are merged into one. Where a robot's precision
  /// is Auto, the finest at which that is all of its clouds that wait.
  void a_message_holds(const PointsAt& points) { holds_ = points; }

  /// The numbers of the updates whose maps `map` replaced; it stands for them from now on. No number is given
  /// twice.
  std::vector<std::uint64_t> add(std::uint64_t number, icd::MapUpdate map, Instant now);

  /// Adds a map that was queued before a restart, in the order of the numbers. It is compared with no other:
  /// a comparison with each would cost time until Adit listens.
  void restore(std::uint64_t number, icd::MapUpdate map, Instant now);

  static constexpr int kInPlace = MapQueue::kInPlace;

  /// The next to be sent, taken out of the lane. Without `now`, nothing rests.
  std::optional<WaitingMap> take(Instant now = Instant::max());

  /// What was sent of each robot's grids: it is to be told what becomes of a grid that was taken.
  Canvases& canvases() { return canvases_; }

  /// A message of that sender took so many bytes of the link: it pays for what is beyond one slot.
  void carried(const Sender& sender, std::size_t bytes);

  /// Puts back a map that could not be sent, or is sent again: first of its sender's, but behind older ones
  /// that are sent again. If a newer grid that waits covers it, that one takes its updates and its age
  /// instead. Gives the numbers of those that are no longer needed, as add() does.
  std::vector<std::uint64_t> put_back(WaitingMap map);

  /// Puts back the parts of what was merged or stitched, first of its sender's and never to be joined again,
  /// so that the part that the Command Post cannot take is found, and the others arrive. Requires parts.
  void put_back_apart(WaitingMap map);

  /// Two clouds of which it is not known whether the newer one has each point of the older one; nothing where
  /// there are none. replace() or keep_both() is to follow.
  std::optional<Successive> to_compare() const;
  /// It has: it stands for the older one from now on, if both wait as they did. Gives numbers as add() does.
  std::vector<std::uint64_t> replace(const Successive& two);
  /// It has not, or nobody knows.
  void keep_both(const Successive& two);

  /// Whether add() would replace one that waits.
  bool replaces_any(const icd::MapUpdate& map) const;
  /// Whether it can be merged or stitched with the last that waits of its sender, within take()'s bounds.
  bool joins(const icd::MapUpdate& map) const;
  /// Whether put_back() would find a newer grid that covers it.
  bool is_replaced(const WaitingMap& map) const;

  std::size_t count() const { return count_; }
  std::size_t count(const Sender& sender) const;
  /// When the oldest news of that sender was accepted; nothing if none waits.
  std::optional<Instant> oldest(const Sender& sender) const;
  std::size_t bytes() const { return bytes_; }  // of memory held by all that wait
  /// Bytes of the data of a grid or a whole cloud: what one that replaces it may need.
  std::size_t largest_replaceable() const;
  /// Senders that it knows of: those that wait, and those that have still to pay for what they sent.
  std::size_t senders() const { return senders_.size(); }

 private:
  struct Waiting {
    MapQueue queue;
    Turn turn;
  };
  using Senders = std::map<Sender, Waiting>;

  Senders::iterator next(Instant now);
  Waiting& joins(const Sender& sender);
  void forget_those_that_are_gone();
  template <class Change>
  auto change(MapQueue& queue, Change change);
  const MapQueue* queue_of(const Sender& sender) const;
  WaitingMap waiting(std::uint64_t number, icd::MapUpdate map, Instant now) const;
  Precision precision_of(const Sender& sender, const MapQueue& queue) const;

  Senders senders_;
  std::map<icd::RobotName, Clouds> clouds_;
  std::map<icd::RobotName, Precision> precisions_;
  PointsAt holds_ = kAnyPoints;
  Turns turns_;
  Canvases canvases_;
  std::size_t merge_bytes_;
  std::size_t slot_bytes_ = 8u << 20;
  std::size_t count_ = 0, bytes_ = 0;
};

}  // namespace adit::lanes
