#pragma once

#include "loop/loop.hpp"

namespace adit::loop {

/// While it lives, the program's clocks (monotonic time and time of day) stand still but for pass(): a test
/// says what time it is. It comes before any Loop that is to live by it, and there is one at a time.
///
/// The program's clock_gettime() comes before libc's, so libstdc++ and sd-event read this time, and the
/// product's code is unchanged. No wait of the kernel ends by it: turn the loop after pass(). Monotonic time
/// is a day ahead of the kernel's, so that no timer that sd-event sets in the kernel expires by itself.
class SimulatedTime {
 public:
  SimulatedTime();
  ~SimulatedTime();
  SimulatedTime(const SimulatedTime&) = delete;
  SimulatedTime& operator=(const SimulatedTime&) = delete;

  /// May be called on any thread.
  void pass(Duration length);
  /// In steps of a millisecond, and `loop` turns at each, as it would on an idle machine.
  void pass(Loop& loop, Duration length);
  /// The same until `done`, or for `most`. Whether it is done.
  template <class Done>
  [[nodiscard]] bool pass_until(Loop& loop, const Done& done, Duration most = std::chrono::minutes(1)) {
    for (Duration passed{}; !done() && passed < most; passed += kStep) pass(loop, kStep);
    return done();
  }

 private:
  static constexpr std::chrono::milliseconds kStep{1};
};

}  // namespace adit::loop
