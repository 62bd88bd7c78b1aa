#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "icd/state_update.hpp"
#include "lanes/map_lane.hpp"

namespace adit::lanes {

/// A /state/update to be sent, and how many accepted updates it answers for.
struct WaitingState {
  icd::StateUpdate update;    // every robot known, by name; header.stamp: the newest of them
  Instant accepted;           // of the oldest news in it
  std::uint64_t updates = 0;  // at least 1
};

/// Robots' newest poses (ICD 6.5): each robot may post alone, all go out together, also those without news.
class StateLane {
 public:
  /// What the lane holds at most, so that no sender can fill the memory.
  static constexpr std::size_t kMostRobots = 1000;
  bool has_room_for(const icd::StateUpdate& update) const;

  /// `update.header.stamp` is on the gateway's clock. A robot's pose is replaced unless the one held has a
  /// newer stamp.
  void add(const icd::StateUpdate& update, Instant now);

  /// All robots' newest poses; nothing where no news came since the last take().
  std::optional<WaitingState> take();
  /// What could not be sent is news again; newer poses that came meanwhile stay.
  void put_back(const WaitingState& state);

  std::optional<Instant> oldest() const { return oldest_; }
  bool empty() const { return !oldest_; }  // no news

 private:
  struct Held {
    bool older_than(std::optional<icd::Stamp> other) const { return !stamp || !other || *stamp <= *other; }

    icd::Pose pose;
    std::optional<icd::Stamp> stamp;
  };
  std::map<icd::RobotName, Held> robots_;
  std::optional<Instant> oldest_;
  std::uint64_t updates_ = 0;
};

}  // namespace adit::lanes
