#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "icd/markers_update.hpp"
#include "lanes/map_lane.hpp"
#include "lanes/marker_changes.hpp"
#include "lanes/waiting_updates.hpp"

namespace adit::lanes {

struct WaitingMarkers {
  icd::MarkersUpdate update;
  Instant accepted;           // when the oldest news in it was accepted
  std::uint64_t updates = 0;  // how many accepted updates it is the last message of
  bool is_ahead = false;      // it goes ahead of what waits, and waits still itself
};

/// The most that a lane of markers holds and gives out; bytes as icd::bytes_of counts them.
struct MarkerBounds {
  std::size_t per_message = 2000;           // markers; at least 1
  std::size_t bytes_per_message = 1 << 20;  // unless a single marker is larger
  std::size_t bytes = 32 << 20;             // of all that wait
};

/// The changes of markers that wait for the Command Post, oldest first.
class MarkerLane {
 public:
  static constexpr std::size_t kMostMarkers = 100'000;

  explicit MarkerLane(MarkerBounds bounds) : bounds_(bounds), most_now_(bounds.per_message) {}

  /// The limits from now on; what waits already stays.
  void keep_within(MarkerBounds bounds);

  /// Bounded, so that no sender can fill the memory while the Command Post is away. A quarter of the bytes is
  /// kept for updates that only replace changes that wait: a path that grows is taken when new markers are
  /// not. If nothing waits, there is room for any update.
  bool has_room_for(const icd::MarkersUpdate& update) const;
  /// Of an update for which there is no room: what changes markers that wait already, so that a full lane
  /// holds the newest of each. Without what stands before its last DeleteAll, which is needless.
  icd::MarkersUpdate those_that_wait(const icd::MarkersUpdate& update) const;
  void add(icd::MarkersUpdate update, Instant now);
  /// The same in parts, where it is so large that all at once would take long: `some` of its markers, which
  /// are moved from, and `last` as the part before gave it, or kNowhere; after the last part,
  /// end_of_update(). Nothing is taken meanwhile.
  MarkerChanges::Place add_part(std::span<icd::Marker> some, MarkerChanges::Place last);
  void end_of_update(MarkerChanges::Place last, Instant now);
  /// What a DeleteAll made needless since this was asked last: to free much of that takes long, and any
  /// thread may do it.
  std::vector<MarkerChanges> needless() { return std::exchange(needless_, {}); }
  /// The oldest pending changes, in order. Updates are counted in the message that sends the last of their
  /// markers.
  std::optional<WaitingMarkers> take();
  /// Puts back what take() gave last and could not be sent: ahead of what came meanwhile, and merged with it.
  /// Costs by what is put back, not by what waits.
  void put_back(const WaitingMarkers& markers);
  /// The same, and sends half as many at a time from now on: if the Command Post does not take several, the
  /// one at fault is found.
  void put_back_narrower(const WaitingMarkers& markers);
  /// Puts a single change that could not be sent behind all others, unless these make it needless. A
  /// DeleteAll stays first, because what follows depends on it: instead, one of those that follow is given
  /// out once ahead of it, in turn, and still waits. That changes nothing in the end, and shows whether
  /// others pass.
  void put_behind(const WaitingMarkers& markers);
  /// Whether what waits makes an earlier change of that marker needless.
  bool says_more_than(const icd::Marker& earlier) const { return changes_.says_more_than(earlier); }
  /// They were taken: twice as many may go next.
  void passed() { most_now_ = std::min(bounds_.per_message, most_now_ * 2); }

  std::size_t count() const { return changes_.size().count; }  // of markers
  std::size_t bytes() const { return changes_.size().bytes; }
  /// All that wait, in order.
  std::vector<icd::Marker> pending() const;
  std::optional<Instant> oldest() const { return updates_.oldest(); }
  bool empty() const { return updates_.empty(); }

 private:
  std::optional<icd::Marker> one_ahead();

  MarkerBounds bounds_;
  std::size_t most_now_;       // markers in the next message
  bool may_go_ahead_ = false;  // the DeleteAll that is first has failed: something else goes once
  MarkerChanges::Place ahead_ = WaitingUpdates::kNowhere;  // of the last that went ahead
  MarkerChanges changes_;
  WaitingUpdates updates_;
  std::vector<MarkerChanges> needless_;
};

}  // namespace adit::lanes
