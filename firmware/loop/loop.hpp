#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

namespace adit::loop {

using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// A thing the loop watches; destroying it ends the watch, also from within its own callback. A callback that
/// throws has ended there (guard.hpp), and is called again as if it had returned. For watch(): destroy the
/// Source before closing its file descriptor.
class Source {
 public:
  Source() = default;
  Source(Source&&) noexcept;
  Source& operator=(Source&&) noexcept;
  ~Source();

  /// For watch(): the EPOLL* events to wait for from now on; 0: none at all, not even EPOLLHUP.
  void wait_for(std::uint32_t events);
  /// For timer(): calls once at `when`; an earlier setting is forgotten.
  void call_at(Instant when);
  /// For timer(): no call until the next call_at().
  void cancel();
  explicit operator bool() const { return state_ != nullptr; }

 private:
  friend class Loop;
  struct State;
  explicit Source(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;  // shared with the callback while that runs
};

/// The one event loop (sd-event). Everything but post() is for the loop's own thread.
class Loop {
 public:
  Loop();
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// The one way to take the time for policy: monotonic.
  Instant now() const;
  /// The gateway's clock for stamps: seconds since 1970 as of start, carried on by the monotonic clock, so
  /// that it never steps but by set_stamp(), whatever becomes of the system's.
  double stamp_now() const;
  /// Sets that clock: an earlier process has given out stamps by it.
  void set_stamp(double now);

  /// The time of day, for people: seconds since 1970 by the system's clock (wall_clock.hpp).
  double wall_now() const;
  /// Where the system's clock is known to be wrong: it is `now`, until somebody sets the system's or finds it
  /// right.
  void set_wall(double now);
  /// By how many seconds it is ahead of the system's.
  double wall_ahead() const;
  /// Looks whether somebody set the system's clock, either way: by how many seconds wall_now() jumps for it.
  /// `system_is_right`: whatever set_wall() was told. To be called each second.
  double look_at_wall(bool system_is_right);

  /// Calls `ready` with the EPOLL* events that came on `fd`, which stays the caller's.
  Source watch(int fd, std::uint32_t events, std::function<void(std::uint32_t)> ready);
  /// A timer, not yet set.
  Source timer(std::function<void()> expired);
  /// Blocks the signal for the process (call before starting threads) and calls `came` for it.
  Source signal(int number, std::function<void()> came);
  /// Runs `task` on the loop's thread, soon, in the order of posting. Thread-safe. What a task posts runs in
  /// a later turn, so that tasks never keep the loop from its sockets. Where it throws (no memory), `task` is
  /// as it was.
  void post(std::function<void()>&& task);

  /// Until stop(), which may also have been called before.
  void run();
  void stop();
  /// One turn, waiting at most `most`; for tests.
  void turn(Duration most);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::loop
