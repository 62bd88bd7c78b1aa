#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::loop {

/// Gives signs of life while the loop turns and every worker answers.
///
/// A worker may be at one job for a while: the largest map is the longest. So a loop that hangs is found out
/// after the `within` of whoever listens, and a worker that hangs `longest_job` later.
class Watchdog {
 public:
  /// A cloud of 256 MB that cannot be compressed is packed in 12 s on a PC's core; the largest that the
  /// settings allow is four times as large, and a small box ten times as slow.
  static constexpr std::chrono::minutes kLongestJob{10};

  /// Calls `feed` four times in each `within` from now on.
  Watchdog(Loop& loop, Duration within, std::function<void()> feed);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Whose answers count from now on beside the loop's. They outlive this, or are replaced first.
  void ask_also(std::vector<Workers*> workers);

 private:
  void look();
  void ask();

  Loop& loop_;
  const Duration every_;
  const std::function<void()> feed_;
  std::vector<Workers*> workers_;
  Source due_;
};

}  // namespace adit::loop
