#pragma once

#include "loop/loop.hpp"

namespace adit::loop {

/// While it exists, the program's clocks (monotonic time and time of day) only move by pass(). Create it
/// before any Loop that uses it; only one may exist. The program's clock_gettime() replaces libc's, so
/// libstdc++ and sd-event read this time without changes of the product's code. Kernel waits do not end by
/// it, so turn the loop after pass(). Monotonic time is a day ahead of the kernel's, so that no timer that
/// sd-event sets in the kernel expires by itself.
class SimulatedTime {
 public:
  SimulatedTime();
  ~SimulatedTime();
  SimulatedTime(const SimulatedTime&) = delete;
  SimulatedTime& operator=(const SimulatedTime&) = delete;

  /// May be called on any thread.
  void pass(Duration length);
  /// Passes in steps of a millisecond, and turns `loop` at each, as on an idle machine.
  void pass(Loop& loop, Duration length);
  /// The same until `done`, for `most` at the most. Returns whether it is done.
  template <class Done>
  [[nodiscard]] bool pass_until(Loop& loop, const Done& done, Duration most = std::chrono::minutes(1)) {
    for (Duration passed{}; !done() && passed < most; passed += kStep) pass(loop, kStep);
    return done();
  }

 private:
  static constexpr std::chrono::milliseconds kStep{1};
};

}  // namespace adit::loop
