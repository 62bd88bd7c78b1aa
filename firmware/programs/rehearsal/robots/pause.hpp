#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace adit::robots {

/// Sleeps until `time`, or less where `stop` is requested.
inline void pause_until(std::chrono::steady_clock::time_point time, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  (void)never.wait_until(lock, stop, time, [] { return false; });
}

}  // namespace adit::robots
