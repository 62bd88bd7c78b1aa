#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "alarms/facts.hpp"

namespace adit::alarms {

/// How often a robot says something; what outlives a restart of the service.
struct Habit {
  int messages = 0;  // at most kMessages count
  double gap = 0;    // seconds, as a rule, between two messages
  double last = 0;   // when it was heard last
};

/// How often each robot says something as a rule, and so when its silence means anything. A new run changes
/// neither.
class Habits {
 public:
  struct Rules {
    double least = 30;   // seconds of silence that say nothing of any robot
    double times = 5;    // its habit
    double away = 1800;  // seconds after which it counts as switched off
  };
  static constexpr int kMessages = 4;  // before which a robot has no habit
  static constexpr std::size_t kMost = 64;

  /// `count`: of its messages of all kinds, since ever. To be told each second; `now`: seconds of
  /// a clock that never steps, when the last of them came. Messages between two calls count as one.
  void heard(const std::string& robot, std::uint64_t count, double now);
  /// Restores the habit from before a restart. `count`: messages that this process counted before its first
  /// heard().
  void carry_on(const std::string& robot, const Habit& habit, std::uint64_t count);
  /// It spoke in this run before a start of the machine, and at most one message is told of since, which may
  /// be of before, too: from now on its silence counts.
  void expect(const std::string& robot, double now);
  /// The habit of one robot, if it is known.
  std::optional<Habit> of(const std::string& robot) const;

  /// Those that have a habit.
  std::map<std::string, Robot> robots(const Rules& rules, double now) const;

 private:
  struct Known {
    std::uint64_t count = 0;
    Habit habit = {};
    bool is_expected = false;   // and nothing was heard of it here
    bool was_expected = false;  // once is enough
  };
  bool has_room(double now);

  std::map<std::string, Known> known_;
};

}  // namespace adit::alarms
