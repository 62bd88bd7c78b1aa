#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "icd/state_update.hpp"
#include "lanes/blame.hpp"
#include "lanes/posted_pose.hpp"

namespace adit::lanes {

/// A /state/update to be sent.
struct WaitingState {
  icd::StateUpdate update;           // every robot of the run, by name; header.stamp: the newest of them
  std::vector<icd::NamedPose> news;  // those that were posted and not sent yet; the others go along
  Instant accepted;                  // of the oldest news in it
};

/// The robots' newest poses (ICD 6.5). Each robot may post alone; all of the run go out together, also those
/// without news.
///
/// If the Command Post does not take a state of several robots, each of them goes in a message of its own
/// until it has been taken once: the one at fault is found, and the others arrive.
class StateLane {
 public:
  /// How long a robot waits after its own state was given up.
  static constexpr std::chrono::seconds kRest{10};

  /// What the lane holds at most, so that no sender can fill the memory. A robot without news makes room.
  static constexpr std::size_t kMostRobots = 1000;
  bool has_room_for(const icd::StateUpdate& update) const;

  /// Those that are not older than the poses held.
  std::vector<PostedPose> news_in(std::span<const PostedPose> poses) const;
  /// They replace the poses held.
  void add(std::span<const PostedPose> news, Instant now);

  /// Makes poses that were given up news again. For a known robot that is its newest pose, if it was given
  /// up; a pose that waits, is under way or was taken stays as it is.
  void add_unless_known(const icd::StateUpdate& update, Instant now);

  /// The newest poses of all robots that go together, or of one that goes apart; nothing if no news came
  /// since the last take(). Without `now`, nobody rests.
  std::optional<WaitingState> take(Instant now = Instant::max());
  /// The next Command Post knows no robot, and is told only of those that have news. Nothing is under way.
  void forget_what_was_taken();
  /// Another run is on: poses that wait go once, those that were taken do not. They were posted before it.
  void begin_run();
  /// What was news and could not be sent is news again; newer poses that came meanwhile stay.
  void put_back(const WaitingState& state);
  /// The same, and from now on each of its robots goes apart.
  void put_back_apart(const WaitingState& state);
  /// It was taken: its robots go together again.
  void passed(const WaitingState& state);
  /// A robot's own state is not sent again; its next one waits for kRest.
  void give_up(const icd::RobotName& name, Instant now);
  /// Of a robot in a state that take() gave.
  Trial& trial_of(const icd::RobotName& name) { return robots_.at(name).trial; }

  /// The newest poses of those robots that have news.
  std::vector<PostedPose> unsent() const;

  /// Whether the Command Post lacks this robot's pose: it waits, or is under way.
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
    bool is_under_way = false;  // what was news when it was taken
    bool apart = false;
    bool is_given_up = false;
    Trial trial{};
  };
  using Robots = std::map<icd::RobotName, Held>;
  std::size_t unknown_in(const auto& poses) const;
  Robots::iterator next_apart(Instant now);
  void include(WaitingState& taken, Robots::value_type& robot);
  Robots robots_;
  std::optional<Instant> oldest_;
};

}  // namespace adit::lanes
