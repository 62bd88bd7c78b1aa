#pragma once

#include <chrono>
#include <cmath>

namespace adit::loop {

/// The time of day as the program tells it: the system's clock, or another where that is known to be wrong.
/// Somebody may set the system's, either way, or find that it is right: that counts from the next look() on,
/// so that whoever looks can bring along what he has noted of the time before. Reads no clock.
class WallClock {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  /// Seconds: both clocks run at one rate, so that by more than this somebody set the system's. Less is how
  /// far apart the two were read, and may wait.
  static constexpr double kSet = 0.01;

  /// `system`: seconds since 1970 by the system's clock, at that instant of the monotonic one; below too.
  WallClock(double system, Instant at) : seen_(system), seen_at_(at) {}

  double now(Instant at) const { return seen_ + seconds(at) + ahead_; }
  /// By how many seconds now() is ahead of the system's.
  double ahead() const { return ahead_; }
  /// It is `now`, until somebody sets the system's or finds it right.
  void set(double now, Instant at) { ahead_ += now - this->now(at); }

  /// By how many seconds now() jumps for this look; 0: it does not. `is_right`: the system's is, whatever was
  /// known before. To be called each second.
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
