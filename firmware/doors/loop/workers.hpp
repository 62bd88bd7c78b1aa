#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "loop/loop.hpp"

namespace adit::loop {

enum class Urgency : std::uint8_t {
  OnTheWay,  // a message or its answer is delayed until the job is done
  CanWait,   // the result is only shown, or memory is freed
};

/// Queues jobs for a few workers and decides which job is next. Reads no clock and does not lock.
///
/// Jobs of one urgency start in order of arrival. OnTheWay jobs go first. A CanWait job goes first if it is
/// at the front, and kPatience has passed since its arrival and since the end of the last CanWait job. So the
/// n-th queued CanWait job waits at most n times kPatience plus the time that other jobs run. With several
/// workers, one always stays free of CanWait jobs.
template <class Job>
class JobQueue {
 public:
  static constexpr std::chrono::milliseconds kPatience{100};
  /// A CanWait job runs for this long before it gives way to OnTheWay jobs.
  static constexpr std::chrono::milliseconds kTurn{10};

  struct NextJob {
    Job job;
    Urgency urgency = Urgency::OnTheWay;
  };

  explicit JobQueue(std::size_t workers) : most_that_can_wait_(std::max<std::size_t>(workers, 2) - 1) {}

  void add(Job job, Urgency urgency, Instant now) {
    if (urgency == Urgency::OnTheWay) {
      on_the_way_.push_back(std::move(job));
    } else {
      can_wait_.push_back({std::move(job), now});
    }
  }

  /// The next job for an idle worker. nullopt: none, or only CanWait jobs while enough workers run such jobs.
  std::optional<NextJob> pop(Instant now) {
    const bool may_wait = !can_wait_.empty() && at_work_ < most_that_can_wait_;
    if (may_wait && (on_the_way_.empty() || is_overdue(now))) {
      NextJob next{std::move(can_wait_.front().job), Urgency::CanWait};
      can_wait_.pop_front();
      ++at_work_;
      return next;
    }
    auto job = pop_shared();
    if (!job) return std::nullopt;
    return NextJob{std::move(*job), Urgency::OnTheWay};
  }

  /// The OnTheWay job to run within a CanWait job that has run since `began` and has given way since `since`.
  /// nullopt: the CanWait job goes on.
  std::optional<Job> pop_amid(Instant began, Instant since, Instant now) {
    if (since - began < kTurn || now - since >= kPatience) return std::nullopt;
    return pop_shared();
  }

  /// Call this when a job from pop() has ended.
  void on_ended(Urgency urgency, Instant now) {
    if (urgency == Urgency::OnTheWay) return;
    --at_work_;
    last_ended_ = now;
  }

  /// Moves all queued jobs to the empty `other`, so that the caller can free them outside its lock.
  void hand_over_to(JobQueue& other) {
    std::swap(other.on_the_way_, on_the_way_);
    std::swap(other.can_wait_, can_wait_);
  }

  std::size_t size() const { return on_the_way_.size() + can_wait_.size(); }

 private:
  struct WaitingJob {
    Job job;
    Instant came{};
  };

  std::optional<Job> pop_shared() {
    if (on_the_way_.empty()) return std::nullopt;
    std::optional<Job> job{std::move(on_the_way_.front())};
    on_the_way_.pop_front();
    return job;
  }
  bool is_overdue(Instant now) const {
    return now - std::max(can_wait_.front().came, last_ended_) >= kPatience;
  }

  const std::size_t most_that_can_wait_;
  std::size_t at_work_ = 0;  // running CanWait jobs
  std::deque<Job> on_the_way_;
  std::deque<WaitingJob> can_wait_;
  Instant last_ended_{};  // of a CanWait job
};

/// Threads that compute on data given to them and return the result to the loop. JobQueue decides which job
/// is next. The threads run at nice 10 (setpriority(2)), so that a report does not compete with them. Jobs
/// that use files belong to a Writer or to the journal's thread.
class Workers {
 public:
  /// `count`: threads; 0: one fewer than the machine's cores, at least one.
  Workers(Loop& loop, unsigned count) : Workers(loop, count, ShutdownPolicy::Drop) {}
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

  /// Runs queued OnTheWay jobs on this thread. Only for `work`: a long CanWait job calls it now and then.
  void give_way();

  /// Asks each worker for a sign of life. Workers answer between jobs.
  void ask();
  /// True if each worker has answered the last ask(), or has run its present job for at most `longest`.
  bool are_responsive(Duration longest) const;

 protected:
  /// What happens to jobs that have not started.
  enum class ShutdownPolicy : std::uint8_t { Drop, Finish };
  Workers(Loop& loop, unsigned count, ShutdownPolicy at_end);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The thread that writes files, at the loop's priority. It runs jobs in order, so that the loop does not
/// wait for a disk and files do not wait for computing. The destructor runs all submitted jobs, but no
/// `done`. Data that a job uses must outlive the Writer.
class Writer final : public Workers {
 public:
  explicit Writer(Loop& loop) : Workers(loop, 1, ShutdownPolicy::Finish) {}

  void submit(std::function<void()> work, std::function<void()> done, std::function<void()> failed) {
    Workers::submit(Urgency::OnTheWay, std::move(work), std::move(done), std::move(failed));
  }
  void submit(std::function<void()> work, std::function<void()> done) {
    Workers::submit(Urgency::OnTheWay, std::move(work), std::move(done));
  }
};

}  // namespace adit::loop
