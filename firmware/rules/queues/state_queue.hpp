#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "icd/mapping.hpp"
#include "queues/blame.hpp"

namespace adit::queues {

/// A robot's pose and the time stamp of its post.
struct PostedPose {
  icd::RobotName name;
  icd::Pose pose;
  std::optional<icd::Stamp> stamp = {};  // on the gateway's clock
  std::string address = {};              // of the client that stamped it; "": not stamped by a client

  /// Whether this pose is older than `held`, which came before it. Two stamps are compared only if one client
  /// set both, because only then they are from one clock. Otherwise false.
  bool is_older_than(const PostedPose& held) const {
    return !address.empty() && address == held.address && stamp < held.stamp;
  }
  icd::NamedPose to_named_pose() const { return {name, pose}; }
  friend bool operator==(const PostedPose&, const PostedPose&) = default;
};

/// A /state/update to be sent.
struct QueuedState {
  icd::StateUpdate update;           // each robot of the run, by name; header.stamp: the newest stamp
  std::vector<icd::NamedPose> news;  // the poses that were not sent before
  Instant accepted;                  // when the oldest news was accepted
};

/// The robots' newest poses (ICD 6.5). Each robot may post alone. A sent state has the poses of all robots of
/// the run, also of those without news. If the Command Post does not accept a state of several robots, each
/// robot goes apart, in a message of its own, until its pose is accepted once. So only the robot at fault
/// fails. It rests between its tries (queues::Blame), and after each of them the others go first.
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

  /// News, and when they may go.
  struct NextState {
    Instant ready{};   // of a robot that does not rest: long ago
    Instant accepted;  // when the pose was accepted
  };
  /// Of the robot whose turn comes first: the oldest news, but robots that rest come last.
  std::optional<NextState> next(Instant now) const;
  /// The newest poses of all robots that go together, or of one robot that goes apart. Nothing if there is no
  /// news, or only of robots that rest. Without `now`, no robot rests.
  std::optional<QueuedState> pop(Instant now = Instant::max());
  /// Drops robots without news, as another Command Post knows no robot. Call while no state is in flight.
  void forget_accepted();
  /// Another run has begun. Poses queued before it are sent once; accepted poses are not sent again.
  void begin_run() {
    for (auto& [name, held] : robots_) held.is_of_run = false;
  }
  /// Queues the news of a state again that was not delivered. Newer poses stay.
  void put_back(const QueuedState& state);
  /// The same, and each of its robots goes apart from now on.
  void put_back_single(const QueuedState& state);
  /// The state was accepted: its robots go together again. If a robot of it had failed alone, and all others
  /// too, there was an outage, and all robots that are not at fault go together again.
  void on_passed(const QueuedState& state);
  /// All robots go together, and none rests.
  void join_all() {
    for (auto& [name, held] : robots_) held.join();
  }
  /// Drops a robot's own state. Its next state rests for kRest.
  void give_up(const icd::RobotName& name, Instant now);
  /// Of a state of one robot that pop() gave. Null: of several, or the robot was dropped to make room.
  Trial* trial_of(const QueuedState& state);

  /// The newest pose of each robot that has news.
  std::vector<PostedPose> unsent() const;

  /// When the robot's pose was accepted that is queued or in flight; nullopt: there is none.
  std::optional<Instant> accepted_at(const icd::RobotName& name) const;
  bool empty() const { return !next({}); }  // no news

 private:
  struct HeldPose {
    bool is_pending() const { return is_news || in_flight; }
    bool can_send() const { return is_news || (is_of_run && !is_given_up); }
    Instant ready() const { return apart ? trial.rests_until : Instant{}; }
    void join() { apart = false, trial = {}; }

    PostedPose posted;
    Instant accepted{};  // of news
    bool is_news = true;
    bool is_of_run = true;
    std::optional<Instant> in_flight{};  // when the pose in flight, which was news before, was accepted
    bool apart = false;
    bool is_given_up = false;
    Trial trial{};
  };
  using Robots = std::map<icd::RobotName, HeldPose>;
  std::size_t unknown_in(const auto& poses) const;
  Robots::iterator next_single(Instant now);
  void include(QueuedState& taken, Robots::value_type& robot);
  Robots robots_;
};

}  // namespace adit::queues
