#pragma once

#include <time.h>

#include <chrono>
#include <memory>

#include "loop/workers.hpp"
#include "patience.hpp"

namespace adit::loop {

/// Longer than any awaited event takes, even on a busy machine.
inline constexpr std::chrono::seconds kTestPatience{30};

/// The kernel's time, even while SimulatedTime stops the program's clocks, for the test's own timeouts.
inline Instant kernel_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC_RAW, &now);
  return Instant(std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec));
}

/// Turns the loop until `done`, for at most `within` times ADIT_PATIENCE. Returns whether it is done.
template <class Done>
[[nodiscard]] bool turn_until(Loop& loop, const Done& done, Duration within = kTestPatience) {
  const Instant end = kernel_now() + patient(within);
  while (!done() && kernel_now() < end) loop.turn(std::chrono::milliseconds{5});
  return done();
}

/// The same, until `writer` has finished all its jobs and their results have arrived.
[[nodiscard]] inline bool turn_until_idle(Loop& loop, Writer& writer) {
  const auto idle = std::make_shared<bool>(false);
  writer.submit([] {}, [idle] { *idle = true; });
  return turn_until(loop, [&idle] { return *idle; });
}

inline void turn_for(Loop& loop, Duration length) {
  for (const Instant end = loop.now() + length; loop.now() < end;) loop.turn(end - loop.now());
}

}  // namespace adit::loop
