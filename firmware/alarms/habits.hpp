#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "alarms/facts.hpp"

namespace adit::alarms {

/// How often each robot says something as a rule, and so when its silence means anything.
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
  /// a clock that never steps. Messages that came between two calls count as one.
  void heard(const std::string& robot, std::uint64_t count, double now);
  /// It spoke in this run before the service began, and at most one message is told of since, which may be of
  /// before, too: from now on its silence counts.
  void expect(const std::string& robot, double now);
  /// Another run: whoever says nothing any more need not be here.
  void forget() { known_.clear(); }

  /// Those that have a habit.
  std::map<std::string, Robot> robots(const Rules& rules, double now) const;

 private:
  struct Known {
    std::uint64_t count = 0;
    int messages = 0;
    double last = 0, gap = 0;
    bool is_expected = false;   // and nothing was heard of it here
    bool was_expected = false;  // once is enough
  };
  std::map<std::string, Known> known_;
};

}  // namespace adit::alarms
