#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "icd/state_update.hpp"
#include "queues/blame.hpp"
#include "queues/posted_pose.hpp"

namespace adit::queues {

/// A /state/update to be sent.
struct QueuedState {
  icd::StateUpdate update;           // each robot of the run, by name; header.stamp: the newest stamp
  std::vector<icd::NamedPose> news;  // the poses that were not sent before
  Instant accepted;                  // when the oldest of `news` was accepted
};

/// The robots' newest poses (ICD 6.5). Each robot may post alone. A sent state has the poses of all robots of
/// the run, also of those without news.
///
/// If the Command Post does not accept a state of several robots, each robot goes apart, in a message of its
/// own, until its pose is accepted once. So only the robot at fault fails.
class StateQueue {
 public:
  /// How long a robot rests after its own state was given up.
  static constexpr std::chrono::seconds kRest{10};

  /// A limit, so that no sender can fill the memory. A robot without news is dropped to make room.
  static constexpr std::size_t kMostRobots = 1000;
  bool has_room_for(const icd::StateUpdate& update) const;

  /// The poses that are not older than the held pose of their robot.
  std::vector<PostedPose> news_in(std::span<const PostedPose> poses) const;
  /// Replaces the held poses by `news`.
  void add(std::span<const PostedPose> news, Instant now);

  /// Queues poses again that were given up. A known robot's newest pose is queued if it was given up. A pose
  /// that is queued, in flight or accepted is not changed.
  void add_unless_known(const icd::StateUpdate& update, Instant now);

  /// The newest poses of all robots that go together, or of one robot that goes apart. Nothing if there is no
  /// news. Without `now`, robots that rest are included.
  std::optional<QueuedState> take(Instant now = Instant::max());
  /// Drops robots without news, because another Command Post knows no robot. Call while no state is in
  /// flight.
  void forget_what_was_taken();
  /// Another run has begun. Queued poses are sent once, because they were posted before it; accepted poses
  /// are not sent again.
  void begin_run();
  /// Queues the news of a state again that was not delivered. Newer poses stay.
  void put_back(const QueuedState& state);
  /// The same, and each of its robots goes apart from now on.
  void put_back_apart(const QueuedState& state);
  /// The state was accepted: its robots go together again.
  void passed(const QueuedState& state);
  /// Drops a robot's own state. Its next state rests for kRest.
  void give_up(const icd::RobotName& name, Instant now);
  /// `name`: of a state that take() gave.
  Trial& trial_of(const icd::RobotName& name) { return robots_.at(name).trial; }

  /// The newest pose of each robot that has news.
  std::vector<PostedPose> unsent() const;

  /// Whether the robot's pose is queued or in flight.
  bool waits(const icd::RobotName& name) const {
    const auto robot = robots_.find(name);
    return robot != robots_.end() && robot->second.waits();
  }
  std::optional<Instant> oldest() const { return oldest_; }
  bool empty() const { return !oldest_; }  // no news

 private:
  struct Held {
    bool waits() const { return is_news || is_under_way; }
    bool goes() const { return is_news || is_of_run; }

    PostedPose posted;
    bool is_news = true;
    bool is_of_run = true;
    bool is_under_way = false;  // it is in flight, and was news before
    bool apart = false;
    bool is_given_up = false;
    Trial trial{};
  };
  using Robots = std::map<icd::RobotName, Held>;
  std::size_t unknown_in(const auto& poses) const;
  Robots::iterator next_apart(Instant now);
  void include(QueuedState& taken, Robots::value_type& robot);
  Robots robots_;
  std::optional<Instant> oldest_;
};

}  // namespace adit::queues
