#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "lanes/blame.hpp"
#include "lanes/marker_changes.hpp"

namespace adit::lanes {

/// The accepted updates whose changes wait, by the last place that any of their changes has: an update is
/// done when all up to there have been taken.
class WaitingUpdates {
 public:
  using Place = MarkerChanges::Place;
  static constexpr auto kNowhere = std::numeric_limits<Place>::min();

  /// So many that end at `last`; `accepted`: the oldest of them.
  void add(Place last, std::uint64_t count, Instant accepted);
  /// The first of them end at `last` instead.
  void move_first_to(Place last);
  /// Takes out those that end before the first of `changes`; gives how many.
  std::uint64_t take_done(const MarkerChanges& changes);
  /// Where the change at their end is gone, they are done with the one before it: there are never many more
  /// ends than changes.
  void join(const MarkerChanges& changes);

  bool empty() const { return by_end_.empty(); }
  std::optional<Instant> oldest() const {
    return accepted_.empty() ? std::nullopt : std::optional(*accepted_.begin());
  }

 private:
  struct Updates {
    std::uint64_t count = 0;
    Instant accepted;  // the oldest of them
  };
  using ByEnd = std::map<Place, Updates>;

  Updates take(ByEnd::iterator updates);

  ByEnd by_end_;
  std::multiset<Instant> accepted_;  // of each
};

}  // namespace adit::lanes
