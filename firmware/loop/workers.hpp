#pragma once

#include <functional>
#include <memory>

#include "loop/loop.hpp"

namespace adit::loop {

/// A few threads that do nothing but CPU work on data handed over to them, and hand the result back to the
/// loop.
class Workers {
 public:
  /// `count` threads; 0: the machine's cores minus one, at least one.
  Workers(Loop& loop, unsigned count);
  /// Jobs that run are waited for; jobs that have not begun are dropped, and no `done` runs any more.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Runs `work` on a worker, then `done` on the loop. Neither may throw. For the loop's thread. First in,
  /// first out.
  void submit(std::function<void()> work, std::function<void()> done);

  /// Asks each worker for a sign of life, which it gives between two jobs.
  void ask();
  /// Whether each has answered the last ask(), or is at a job that it began at most `longest` ago.
  bool are_well(Duration longest) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::loop
