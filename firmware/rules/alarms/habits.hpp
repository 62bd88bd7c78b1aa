#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "alarms/facts.hpp"

namespace adit::alarms {

/// Detects a queue that has grown for a while. One large map does not count as growth.
class Growth {
 public:
  static constexpr double kStep = 10;       // seconds
  static constexpr std::size_t kSteps = 4;  // consecutive ones
  static constexpr double kTelling = 0.05;  // share of the room below which growth is ignored
  static constexpr double kTold = 30;       // seconds that growth is reported after the last rise

  /// Call each second. `now`: monotonic seconds.
  void look(std::size_t bytes, std::size_t room, double now);
  bool grows(double now) const { return grew_ && now - last_ < kTold; }

 private:
  std::deque<std::size_t> least_;  // minimum of each step, the newest last
  double step_at_ = 0, last_ = 0;
  bool begun_ = false, grew_ = false;
};

/// The habit of a robot; outlives a restart of the service.
struct Habit {
  int messages = 0;  // received; kMessages of them make a habit
  double gap = 0;    // usual seconds between two messages
  double last = 0;   // time of the last message
};

/// Usual interval between each robot's messages, and so the silence that matters. A new run does not change
/// it.
class Habits {
 public:
  struct Rules {
    double least = 30;   // seconds of silence that are normal for any robot
    double times = 5;    // multiple of the robot's usual gap
    double away = 1800;  // seconds after which the robot is switched off
  };
  static constexpr int kMessages = 4;  // messages that make a habit
  static constexpr std::size_t kMost = 64;

  /// `count`: the robot's messages of all kinds so far. `now`: monotonic seconds. Call each second; messages
  /// between two calls count as one.
  void heard(const std::string& robot, std::uint64_t count, double now);
  /// Restores the habit from before a restart. `count`: messages counted by this process before its first
  /// heard().
  void carry_on(const std::string& robot, const Habit& habit, std::uint64_t count);
  /// Makes the robot's silence count from now on. For a robot that sent in this run before a reboot, and has
  /// at most one message since, which may be older than the reboot.
  void expect(const std::string& robot, double now);
  /// The habit of one robot, or std::nullopt.
  std::optional<Habit> of(const std::string& robot) const;

  /// The robots that have a habit and are not switched off.
  std::map<std::string, Robot> robots(const Rules& rules, double now) const;

 private:
  struct Known {
    std::uint64_t count = 0;
    Habit habit = {};
    bool is_expected = false;   // no message has come since expect()
    bool was_expected = false;  // a later expect() has no effect
  };
  bool has_room(double now);

  std::map<std::string, Known> known_;
};

}  // namespace adit::alarms
