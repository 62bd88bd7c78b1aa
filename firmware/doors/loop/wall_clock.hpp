#pragma once

#include <chrono>
#include <cmath>

namespace adit::loop {

/// The time of day of the program: the system's clock plus a correction if that clock is wrong. look() drops
/// the correction if the system's clock was set or is right. The caller of look() can then correct earlier
/// times. Reads no clock.
class WallClock {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  /// Seconds. A larger difference from monotonic time means that the system's clock was set. A smaller one is
  /// the time between two readings.
  static constexpr double kSet = 0.01;

  /// `system`: seconds since 1970 by the system's clock at the monotonic time `at`; so in look().
  WallClock(double system, Instant at) : seen_(system), seen_at_(at) {}

  double now(Instant at) const { return seen_ + seconds(at) + ahead_; }
  /// Seconds by which now() is ahead of the system's clock.
  double ahead() const { return ahead_; }
  /// Makes now() return `now` at `at`, until look() drops the correction.
  void set(double now, Instant at) { ahead_ += now - this->now(at); }

  /// Returns the seconds by which now() steps; 0: no step. `is_right`: the system's clock is right, so drop
  /// the correction. Call this each second.
  double look(double system, Instant at, bool is_right) {
    const double step = system - seen_ - seconds(at), before = ahead_;
    const bool gives_way = is_right && before != 0;
    if (std::abs(step) < kSet && !gives_way) return 0;
    seen_ = system;
    seen_at_ = at;
    ahead_ = 0;
    return step - before;
  }

 private:
  double seconds(Instant at) const { return std::chrono::duration<double>(at - seen_at_).count(); }

  double seen_;
  Instant seen_at_;
  double ahead_ = 0;
};

}  // namespace adit::loop
