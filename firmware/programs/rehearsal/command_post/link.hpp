#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <mutex>

#include "rehearsal/command_post/http.hpp"

namespace adit::rehearsal {

/// The link to the Command Post. All connections share its rate in megabits a second: the pieces that they
/// receive arrive one after the other. Safe for use by several threads.
class Link {
 public:
  explicit Link(double megabits) : bits_per_second_(megabits * 1e6) {}

  /// The time from now until `bytes` more have arrived.
  std::chrono::milliseconds pass(std::size_t bytes) {
    constexpr double bits_of_a_byte = 8;
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    free_ = std::max(free_, now) + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                                       static_cast<double>(bytes) * bits_of_a_byte / bits_per_second_));
    return std::chrono::floor<std::chrono::milliseconds>(free_ - now);
  }

 private:
  std::mutex mutex_;
  const double bits_per_second_;
  Clock::time_point free_;  // when the last received piece has arrived
};

}  // namespace adit::rehearsal
