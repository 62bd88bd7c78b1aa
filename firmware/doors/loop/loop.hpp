#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

namespace adit::loop {

/// The time of day of the program: the system's clock plus a correction if that clock is wrong. update()
/// drops the correction if the system's clock was set or is right. The caller of update() can then correct
/// earlier times. Reads no clock.
class WallClock {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  /// Seconds. A larger difference from monotonic time means that the system's clock was set. A smaller one is
  /// the time between two readings.
  static constexpr double kSet = 0.01;

  /// `system`: seconds since 1970 by the system's clock at the monotonic time `at`; so in update().
  WallClock(double system, Instant at) : seen_(system), seen_at_(at) {}

  double now(Instant at) const { return seen_ + seconds(at) + ahead_; }
  /// Seconds by which now() is ahead of the system's clock.
  double offset() const { return ahead_; }
  /// Makes now() return `now` at `at`, until update() drops the correction.
  void set(double now, Instant at) { ahead_ += now - this->now(at); }

  /// Returns the seconds by which now() steps; 0: no step. `is_right`: the system's clock is right, so drop
  /// the correction. Call this each second.
  double update(double system, Instant at, bool is_right) {
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

using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// The system's clock, in seconds since 1970. Rules use Loop::wall_now().
double system_now();

/// A watched descriptor, timer or signal. Destroying it ends the watch, even within its own callback. An
/// exception that leaves the callback ends the process. For watch(): destroy the Source before you close its
/// file descriptor.
class Source {
 public:
  Source() = default;
  Source(Source&&) noexcept;
  Source& operator=(Source&&) noexcept;
  ~Source();

  /// For watch(): sets the awaited EPOLL* events; 0: no event, not even EPOLLHUP.
  void wait_for(std::uint32_t events);
  /// For timer(): calls once at `when`, and replaces an earlier setting.
  void call_at(Instant when);
  /// For timer(): no call until the next call_at().
  void cancel();
  explicit operator bool() const { return state_ != nullptr; }

 private:
  friend class Loop;
  struct State;
  explicit Source(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;  // shared with the running callback
};

/// The event loop (sd-event) of the process. Only post() may be called from other threads.
class Loop {
 public:
  Loop();
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Monotonic time, for all rules.
  Instant now() const;
  /// The clock of time stamps, in seconds since 1970. It is set from the system's clock at process start and
  /// then follows monotonic time. Only set_stamp() steps it.
  double stamp_now() const;
  /// Sets that clock, because time stamps of an earlier process may be ahead of it.
  void set_stamp(double now);

  /// The time of day for people: seconds since 1970.
  double wall_now() const;
  /// Sets the time of day to `now`, because the system's clock is wrong. This holds until check_wall_clock()
  /// finds that the system's clock was set or is right.
  void set_wall(double now);
  /// Seconds by which wall_now() is ahead of the system's clock.
  double wall_offset() const;
  /// Checks whether the system's clock was set. Returns the seconds by which wall_now() steps.
  /// `system_is_right`: drop the correction of set_wall(). Call this each second.
  double check_wall_clock(bool system_is_right);

  /// Calls `ready` with the EPOLL* events of `fd`. The caller keeps `fd`.
  Source watch(int fd, std::uint32_t events, std::function<void(std::uint32_t)> ready);
  /// A timer that is not set.
  Source timer(std::function<void()> expired);
  /// Blocks the signal in the calling thread and calls `came` when it arrives. Call this before starting
  /// threads, because they inherit the block.
  Source signal(int number, std::function<void()> came);
  /// Runs `task` on the loop's thread, soon, in the order of posting. Thread-safe. A task that a task posts
  /// runs in a later turn, so that tasks do not starve the sockets. If post() throws, `task` is unchanged.
  void post(std::function<void()>&& task);

  /// Runs until stop(). Returns at once if stop() was called before.
  void run();
  void stop();
  /// One turn that waits at most `most`; for tests.
  void turn(Duration most);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::loop
