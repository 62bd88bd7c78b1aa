#include "loop/workers.hpp"

#include <pthread.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace adit::loop {
namespace {

unsigned threads_for(unsigned asked) {
  if (asked > 0) return asked;
  return std::max(std::thread::hardware_concurrency(), 2u) - 1;
}

/// Signals are the loop's: threads begun while this lives take none.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
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
  Impl(Loop& loop, unsigned count) : loop_(loop), lives_(threads_for(count)) {
    const SignalsBlocked blocked;
    for (Life& life : lives_) {
      threads_.emplace_back([this, &life] { serve(life); });
      pthread_setname_np(threads_.back().native_handle(), "worker");
    }
  }

  ~Impl() {
    *alive_ = false;
    std::deque<Job> dropped;  // outlives the lock: what a job holds is freed outside it
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      dropped.swap(jobs_);
    }
    came_.notify_all();
    for (auto& thread : threads_) thread.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void submit(std::function<void()> work, std::function<void()> done) {
    {
      const std::lock_guard lock(mutex_);
      jobs_.push_back({std::move(work), std::move(done)});
    }
    came_.notify_one();
  }

  void ask() {
    {
      const std::lock_guard lock(mutex_);
      ++asked_;
    }
    came_.notify_all();
  }
  bool are_well(Duration longest) {
    const Instant now = loop_.now();
    const std::lock_guard lock(mutex_);
    return std::ranges::all_of(lives_, [&](const Life& life) {
      return life.answered == asked_ || (life.at_work && now - life.began <= longest);
    });
  }

 private:
  struct Job {
    std::function<void()> work;
    std::function<void()> done;
  };

  /// What is known of a worker.
  struct Life {
    std::uint64_t answered = 0;  // the last ask() that it has heard
    bool at_work = false;
    Instant began{};  // its job
  };

  void serve(Life& life) noexcept {
    while (true) {
      Job job;
      {
        std::unique_lock lock(mutex_);
        life.at_work = false;
        life.answered = asked_;
        while (!stopping_ && jobs_.empty()) {
          came_.wait(lock);
          life.answered = asked_;
        }
        if (stopping_) return;
        job = std::move(jobs_.front());
        jobs_.pop_front();
        life.at_work = true;
        life.began = loop_.now();
      }
      job.work();
      job.work = nullptr;  // freed here, so that `done` finds its data its own
      loop_.post([alive = alive_, done = std::move(job.done)] {
        if (*alive) done();
      });
    }
  }

  Loop& loop_;
  const std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // read and written on the loop alone
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<Job> jobs_;
  bool stopping_ = false;
  std::uint64_t asked_ = 0;
  std::vector<Life> lives_;  // one for each thread
  std::vector<std::thread> threads_;
};

Workers::Workers(Loop& loop, unsigned count) : impl_(std::make_unique<Impl>(loop, count)) {}
Workers::~Workers() = default;

void Workers::submit(std::function<void()> work, std::function<void()> done) {
  impl_->submit(std::move(work), std::move(done));
}
void Workers::ask() {
  impl_->ask();
}
bool Workers::are_well(Duration longest) const {
  return impl_->are_well(longest);
}

}  // namespace adit::loop
