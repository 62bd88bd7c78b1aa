#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "icd/markers_update.hpp"
#include "lanes/map_lane.hpp"
#include "lanes/marker_changes.hpp"

namespace adit::lanes {

struct WaitingMarkers {
  icd::MarkersUpdate update;
  Instant accepted;           // when the oldest news in it was accepted
  std::uint64_t updates = 0;  // how many accepted updates it is the last message of
  bool is_ahead = false;      // it goes ahead of what waits, and waits still itself
};

/// What a lane of markers holds and gives out at most; bytes are those of icd::bytes_of.
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

  /// These count from now on; what waits, waits.
  void keep_within(MarkerBounds bounds);

  /// So that no sender can fill the memory while the Command Post is away. What only replaces changes that
  /// wait has a quarter of the bytes to itself: a path that grows is taken when new markers are not. Where
  /// nothing waits there is room for any update.
  bool has_room_for(const icd::MarkersUpdate& update) const;
  void add(const icd::MarkersUpdate& update, Instant now);
  /// The oldest pending changes, in order. Updates are counted in the message that sends the last of their
  /// markers.
  std::optional<WaitingMarkers> take();
  /// What take() gave last and could not be sent goes before what came meanwhile, merged with it.
  void put_back(const WaitingMarkers& markers);
  /// The same, but of half as many at a time from now on: where the Command Post will not take several, the
  /// one at fault is found.
  void put_back_narrower(const WaitingMarkers& markers);
  /// A single change that could not be sent goes behind all others, unless these make it needless. Not one
  /// that deletes all, for what follows it depends on it: in its place one of those that follow is given out
  /// once ahead of it, by turns, and waits still. That changes nothing in the end, and shows whether others
  /// pass.
  void put_behind(const WaitingMarkers& markers);
  /// Whether what waits makes an earlier change of that marker needless.
  bool says_more_than(const icd::Marker& earlier) const { return changes_.says_more_than(earlier); }
  /// They were taken: twice as many may go next.
  void passed() { most_now_ = std::min(bounds_.per_message, most_now_ * 2); }

  std::size_t count() const { return changes_.size().count; }  // of markers
  std::size_t bytes() const { return changes_.size().bytes; }
  /// All that wait, in order.
  std::vector<icd::Marker> pending() const;
  std::optional<Instant> oldest() const { return oldest_; }
  bool empty() const { return updates_.empty(); }

 private:
  using Place = MarkerChanges::Place;
  static constexpr auto kNowhere = std::numeric_limits<Place>::min();

  struct Updates {
    std::uint64_t count = 0;
    Instant accepted;  // the oldest of them
  };
  /// By the last place that any of their changes has: they are done when all up to there have been taken.
  using UpdatesByPlace = std::map<Place, Updates>;

  std::optional<icd::Marker> one_ahead();
  static void add_to(UpdatesByPlace& all, Place last, const Updates& updates);
  void join_updates();
  void find_oldest();

  MarkerBounds bounds_;
  std::size_t most_now_;       // markers in the next message
  bool may_go_ahead_ = false;  // the DeleteAll that is first has failed: something else goes once
  std::size_t ahead_ = 0;      // how many went ahead
  MarkerChanges changes_;
  UpdatesByPlace updates_;
  std::optional<Instant> oldest_;
};

}  // namespace adit::lanes
