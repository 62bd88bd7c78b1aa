#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "loop/job_queue.hpp"
#include "loop/loop.hpp"

namespace adit::loop {

/// A few threads that do nothing but CPU work on data handed over to them, and hand the result back to the
/// loop. JobQueue says which job is next. They run at nice 10 (setpriority(2)), so that a report does not
/// compete with them. What touches a file is a Writer's, or that of a thread for which nobody waits: the
/// journal's.
class Workers {
 public:
  /// `count` threads; 0: the machine's cores minus one, at least one.
  Workers(Loop& loop, unsigned count) : Workers(loop, count, AtEnd::Drop) {}
  /// Jobs that run are waited for; jobs that have not begun are dropped, and no `done` runs any more.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Runs `work` on a worker, then `done` on the loop, or `failed` where `work` threw (guard.hpp): whatever
  /// was left half done is not used then. For the loop's thread. Of one urgency first in, first out.
  void submit(Urgency urgency, std::function<void()> work, std::function<void()> done,
              std::function<void()> failed);
  /// For work whose result is a failure until it says otherwise: `done` runs in either case.
  void submit(Urgency urgency, std::function<void()> work, std::function<void()> done);

  /// To be called now and then by `work` that can wait and takes long: what is on the way is done meanwhile,
  /// on the same thread.
  void give_way();

  /// Asks each worker for a sign of life, which it gives between two jobs.
  void ask();
  /// Whether each has answered the last ask(), or is at a job that it began at most `longest` ago.
  bool are_well(Duration longest) const;

 protected:
  /// What becomes of jobs that have not begun.
  enum class AtEnd : std::uint8_t { Drop, Finish };
  Workers(Loop& loop, unsigned count, AtEnd at_end);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The one thread that writes files, at the loop's priority: one job after the other, in the order in which
/// they were submitted, so that the loop waits for no disk and no file waits for CPU work. At its end all
/// that was submitted is done (though no `done` runs any more): whatever a job uses outlives it.
class Writer final : public Workers {
 public:
  explicit Writer(Loop& loop) : Workers(loop, 1, AtEnd::Finish) {}

  void submit(std::function<void()> work, std::function<void()> done, std::function<void()> failed) {
    Workers::submit(Urgency::OnTheWay, std::move(work), std::move(done), std::move(failed));
  }
  void submit(std::function<void()> work, std::function<void()> done) {
    Workers::submit(Urgency::OnTheWay, std::move(work), std::move(done));
  }
};

}  // namespace adit::loop
