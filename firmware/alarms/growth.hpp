#pragma once

#include <cstddef>
#include <deque>

namespace adit::alarms {

/// Whether what waits has grown for a while: not what one large map does.
class Growth {
 public:
  static constexpr double kStep = 10;       // seconds
  static constexpr std::size_t kSteps = 4;  // one after the other
  static constexpr double kTelling = 0.05;  // of the room: less is no queue
  static constexpr double kTold = 30;       // seconds that it is told of after it grew last

  /// To be told each second. `now`: seconds of a clock that never steps.
  void look(std::size_t bytes, std::size_t room, double now);
  bool grows(double now) const { return grew_ && now - last_ < kTold; }

 private:
  std::deque<std::size_t> least_;  // of each step, the newest last
  double step_at_ = 0, last_ = 0;
  bool begun_ = false, grew_ = false;
};

}  // namespace adit::alarms
