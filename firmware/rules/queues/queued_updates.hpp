#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "queues/blame.hpp"
#include "queues/marker_changes.hpp"

namespace adit::queues {

/// The accepted marker updates with queued changes, by the place of their last change. An update is done once
/// all changes up to that place were taken out of the queue.
class QueuedUpdates {
 public:
  using Place = MarkerChanges::Place;
  static constexpr auto kNowhere = std::numeric_limits<Place>::min();

  /// Adds `count` updates that end at `last`; `accepted`: when the oldest of them was accepted.
  void add(Place last, std::uint64_t count, Instant accepted);
  /// Moves the end of the first updates to `last`.
  void move_first_to(Place last);
  /// Removes the updates that end before the first of `changes`, and returns their number.
  std::uint64_t take_done(const MarkerChanges& changes);
  /// If the last change of an update is gone, the update ends at the change before it. This bounds the number
  /// of ends by that of changes.
  void join(const MarkerChanges& changes);

  bool empty() const { return by_end_.empty(); }
  std::optional<Instant> oldest() const {
    return accepted_.empty() ? std::nullopt : std::optional(*accepted_.begin());
  }

 private:
  struct Updates {
    std::uint64_t count = 0;
    Instant accepted;  // of the oldest
  };
  using ByEnd = std::map<Place, Updates>;

  Updates take(ByEnd::iterator updates);

  ByEnd by_end_;
  std::multiset<Instant> accepted_;  // of each
};

}  // namespace adit::queues
