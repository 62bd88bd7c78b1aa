#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::loop {

/// Gives signs of life while the loop turns and each worker answers.
///
/// A worker may run one job for up to kLongestJob; the largest map takes longest. So a hung loop is found
/// after `within`, and a hung worker kLongestJob later.
class Watchdog {
 public:
  /// A cloud of 256 MB that cannot be compressed takes 12 s on a PC's core. The largest cloud that the
  /// settings allow is four times as large, and a small box is ten times as slow.
  static constexpr std::chrono::minutes kLongestJob{10};

  /// Calls `feed` at once, and then four times in each `within`.
  Watchdog(Loop& loop, Duration within, std::function<void()> feed);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Sets the workers whose answers are also required. They must outlive this object or its next call.
  void watch_workers(std::vector<Workers*> workers);

 private:
  void check();
  void ask();

  Loop& loop_;
  const Duration every_;
  const std::function<void()> feed_;
  std::vector<Workers*> workers_;
  Source due_;
};

/// Finds out that a job of a worker takes longer than Watchdog::kLongestJob. For one job at a time.
class JobWatch {
 public:
  /// `overruns`: called once for such a job, before the watchdog starves.
  JobWatch(Loop& loop, std::function<void()> overruns);

  /// The job is submitted: it calls the result when it starts. The job may outlive this object.
  std::function<void()> begin();
  void end() { due_.cancel(); }

 private:
  void check();

  Loop& loop_;
  const std::function<void()> overruns_;
  std::shared_ptr<std::atomic<Instant>> started_;  // zero: not yet
  Source due_;
};

}  // namespace adit::loop
