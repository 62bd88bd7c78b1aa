#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "loop/job_queue.hpp"
#include "loop/loop.hpp"

namespace adit::loop {

/// Threads that compute on data given to them and return the result to the loop. JobQueue decides which job
/// is next. The threads run at nice 10 (setpriority(2)), so that a report does not compete with them. Jobs
/// that use files belong to a Writer or to the journal's thread.
class Workers {
 public:
  /// `count`: threads; 0: one fewer than the machine's cores, at least one.
  Workers(Loop& loop, unsigned count) : Workers(loop, count, AtEnd::Drop) {}
  /// Waits for running jobs. Drops queued jobs. `done` and `failed` are not called any more.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Runs `work` on a worker, then `done` on the loop, or `failed` if `work` threw (guard.hpp). Call it on
  /// the loop's thread. Jobs of one urgency start in order.
  void submit(Urgency urgency, std::function<void()> work, std::function<void()> done,
              std::function<void()> failed);
  /// The same with `done` in place of `failed`, for work whose result is a failure until `work` sets it.
  void submit(Urgency urgency, std::function<void()> work, std::function<void()> done);

  /// Runs queued OnTheWay jobs on this thread. Only for `work`: a long CanWait job calls it from time to
  /// time.
  void give_way();

  /// Asks each worker for a sign of life. Workers answer between jobs.
  void ask();
  /// True if each worker has answered the last ask(), or has run its present job for at most `longest`.
  bool are_well(Duration longest) const;

 protected:
  /// What happens to jobs that have not started.
  enum class AtEnd : std::uint8_t { Drop, Finish };
  Workers(Loop& loop, unsigned count, AtEnd at_end);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The thread that writes files, at the loop's priority. It runs jobs in order, so that the loop does not
/// wait for a disk and files do not wait for computing. The destructor runs all submitted jobs, but no
/// `done`. Data that a job uses must outlive the Writer.
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
