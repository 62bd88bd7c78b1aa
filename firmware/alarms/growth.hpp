#pragma once

#include <cstddef>
#include <deque>

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

}  // namespace adit::alarms
