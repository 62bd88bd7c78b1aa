#include "loop/simulated_time.hpp"

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

namespace adit::loop {
namespace {

constexpr std::int64_t kRuns = -1;
constexpr std::int64_t kSecond = 1'000'000'000, kDay = 86400 * kSecond;  // nanoseconds

std::atomic<std::int64_t> passed = kRuns;          // nanoseconds since the clocks were stopped
std::atomic<std::int64_t> monotonic, time_of_day;  // at that time

timespec kernel_time(clockid_t clock) {
  timespec now{};
  ::syscall(SYS_clock_gettime, clock, &now);
  return now;
}
/// Whole seconds, so that rounding never cuts a step of the simulation.
std::int64_t seconds_of(clockid_t clock) {
  return kernel_time(clock).tv_sec * kSecond;
}

}  // namespace

/// Replaces libc's function: in ELF, a program's symbols come before a library's.
extern "C" [[gnu::visibility("default")]] int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const std::int64_t since = passed;
  if (since == kRuns || (clock != CLOCK_MONOTONIC && clock != CLOCK_REALTIME)) {
    return static_cast<int>(::syscall(SYS_clock_gettime, clock, now));
  }
  const std::int64_t all = since + (clock == CLOCK_MONOTONIC ? monotonic : time_of_day);
  *now = {.tv_sec = all / kSecond, .tv_nsec = all % kSecond};
  return 0;
}

SimulatedTime::SimulatedTime() {
  monotonic = seconds_of(CLOCK_MONOTONIC) + kDay;
  time_of_day = seconds_of(CLOCK_REALTIME);
  passed = 0;
}

SimulatedTime::~SimulatedTime() {
  passed = kRuns;
}

void SimulatedTime::pass(Duration length) {
  passed += length.count();
}

void SimulatedTime::pass(Loop& loop, Duration length) {
  constexpr int kDueAtOnce = 4;  // a turn handles one due event
  for (Duration left = length; left > Duration{}; left -= kStep) {
    pass(std::min<Duration>(left, kStep));
    loop.turn(Duration{});
  }
  for (int i = 0; i < kDueAtOnce; ++i) loop.turn(Duration{});
}

}  // namespace adit::loop
