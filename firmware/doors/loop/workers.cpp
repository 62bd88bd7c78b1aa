#include "loop/workers.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "loop/guard.hpp"

namespace adit::loop {
namespace {

unsigned threads_for(unsigned asked) {
  if (asked > 0) return asked;
  return std::max(std::thread::hardware_concurrency(), 2u) - 1;
}

/// Lowers the calling thread's priority below the loop's and the writer's, if the system allows it.
void lower_priority() {
  constexpr int kNice = 10;
  const auto thread = static_cast<id_t>(gettid());
  if (getpriority(PRIO_PROCESS, thread) < kNice) (void)setpriority(PRIO_PROCESS, thread, kNice);
}

/// While this object lives, new threads block all signals, because signals belong to the loop. Except a
/// fault's: it would end the process without its handler (guard.hpp).
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    for (const int fault : {SIGSEGV, SIGBUS, SIGILL, SIGFPE}) sigdelset(&all, fault);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

class Workers::Impl {
 public:
  Impl(Loop& loop, unsigned count, ShutdownPolicy at_end)
      : loop_(loop), at_end_(at_end), jobs_(threads_for(count)), lives_(threads_for(count)) {
    const SignalsBlocked blocked;
    for (WorkerState& life : lives_) {
      threads_.emplace_back([this, &life] { serve(life); });
      pthread_setname_np(threads_.back().native_handle(),
                         at_end == ShutdownPolicy::Finish ? "writer" : "worker");
    }
  }

  ~Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// A running job may use the Workers until the job ends.
  void end() {
    *alive_ = false;
    JobQueue<Job> dropped(lives_.size());  // outlives the lock, so that the jobs' data is freed without it
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      if (at_end_ == ShutdownPolicy::Drop) jobs_.hand_over_to(dropped);
    }
    came_.notify_all();
    for (auto& thread : threads_) thread.join();
  }

  void submit(Urgency urgency, std::function<void()> work, std::function<void()> done,
              std::function<void()> failed) {
    Job job = job_of(std::move(work), {std::move(done), std::move(failed)});
    {
      const std::lock_guard lock(mutex_);
      jobs_.add(std::move(job), urgency, loop_.now());
    }
    came_.notify_one();
  }

  void give_way() {
    WorkerState& life = *of_this_thread_;
    const Instant since = loop_.now();
    bool gave = false;
    while (auto job = take_amid(life, since)) {
      run(*job);
      gave = true;
    }
    if (gave) restart_timer(life);
  }

  void ask() {
    {
      const std::lock_guard lock(mutex_);
      ++asked_;
    }
    came_.notify_all();
  }
  bool are_responsive(Duration longest) {
    const Instant now = loop_.now();
    const std::lock_guard lock(mutex_);
    return std::ranges::all_of(lives_, [&](const WorkerState& life) {
      return life.answered == asked_ || (life.at_work && now - life.began <= longest);
    });
  }

 private:
  /// The callbacks after a job. Only the loop calls and frees them; the worker sets `well`.
  struct JobCallbacks {
    std::function<void()> done, failed;
    bool well = false;
  };
  struct Job {
    std::function<void()> work;
    std::function<void()> end;
    JobCallbacks* ends = nullptr;  // owned by `end`
  };

  Job job_of(std::function<void()> work, JobCallbacks ends) const {
    const auto held = std::make_shared<JobCallbacks>(std::move(ends));
    return {std::move(work),
            [alive = alive_, held] {
              if (*alive) (held->well ? held->done : held->failed)();
            },
            held.get()};
  }

  struct WorkerState {
    std::uint64_t answered = 0;  // the last ask() that it has seen
    bool at_work = false;
    Instant began{};  // when its job began or continued
  };

  void serve(WorkerState& life) noexcept {
    of_this_thread_ = &life;
    if (at_end_ == ShutdownPolicy::Drop) lower_priority();
    while (auto next = wait_for_next(life)) {
      run(next->job);
      const std::lock_guard lock(mutex_);
      jobs_.on_ended(next->urgency, loop_.now());
    }
  }

  /// nullopt: the Workers stop.
  std::optional<JobQueue<Job>::NextJob> wait_for_next(WorkerState& life) {
    std::unique_lock lock(mutex_);
    life.at_work = false;
    life.answered = asked_;
    auto next = jobs_.pop(loop_.now());
    while (!next && !stopping_) {
      came_.wait(lock);
      life.answered = asked_;
      next = jobs_.pop(loop_.now());
    }
    life.at_work = true;
    life.began = loop_.now();
    return next;
  }

  std::optional<Job> take_amid(WorkerState& life, Instant since) {
    const std::lock_guard lock(mutex_);
    return jobs_.pop_amid(life.began, since, loop_.now());
  }
  void restart_timer(WorkerState& life) {
    const std::lock_guard lock(mutex_);
    life.began = loop_.now();
  }

  void run(Job& job) noexcept {
    job.ends->well = run_guarded("a job of a worker", job.work);
    job.work = nullptr;  // freed here, so that `done` is the only owner of its data
    loop_.post(std::move(job.end));
  }

  Loop& loop_;
  const ShutdownPolicy at_end_;
  const std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // read and written on the loop only
  std::mutex mutex_;
  std::condition_variable came_;
  JobQueue<Job> jobs_;
  bool stopping_ = false;
  std::uint64_t asked_ = 0;
  std::vector<WorkerState> lives_;  // one for each thread
  static thread_local WorkerState* of_this_thread_;
  std::vector<std::thread> threads_;
};

thread_local Workers::Impl::WorkerState* Workers::Impl::of_this_thread_ = nullptr;

Workers::Workers(Loop& loop, unsigned count, ShutdownPolicy at_end)
    : impl_(std::make_unique<Impl>(loop, count, at_end)) {}
Workers::~Workers() {
  impl_->end();
}

void Workers::submit(Urgency urgency, std::function<void()> work, std::function<void()> done,
                     std::function<void()> failed) {
  impl_->submit(urgency, std::move(work), std::move(done), std::move(failed));
}
void Workers::submit(Urgency urgency, std::function<void()> work, std::function<void()> done) {
  const auto either = std::make_shared<std::function<void()>>(std::move(done));
  impl_->submit(urgency, std::move(work), [either] { (*either)(); }, [either] { (*either)(); });
}
void Workers::give_way() {
  impl_->give_way();
}
void Workers::ask() {
  impl_->ask();
}
bool Workers::are_responsive(Duration longest) const {
  return impl_->are_responsive(longest);
}

}  // namespace adit::loop
