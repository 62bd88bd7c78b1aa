// loop/workers.hpp over the simulated world: each job runs whole at a drawn time, and its end comes at a
// later one.
#include <algorithm>
#include <deque>
#include <utility>

#include "loop/guard.hpp"
#include "loop/workers.hpp"
#include "simulation/world.hpp"

namespace adit::loop {
namespace {

using simulation::World;

/// Seconds before a job begins, and that it takes; now and then the machine is busy.
constexpr double kBegins = 0.0005, kTakes = 0.004, kBusy = 0.15;

class Pool : public std::enable_shared_from_this<Pool> {
 public:
  Pool(Loop& loop, unsigned count, bool finishes)
      : loop_(loop),
        idle_(count == 0 ? 2 : count),
        finishes_(finishes),
        random_(world_.random("workers " + std::to_string(world_.entropy()))) {}

  void submit(std::function<void()> work, std::function<void()> done, std::function<void()> failed) {
    jobs_.push_back({std::move(work), std::move(done), std::move(failed)});
    begin_one();
  }

  void end() {
    over_ = true;
    if (finishes_) {
      for (Job& job : jobs_) guarded("a job of a worker", job.work);
    }
    jobs_.clear();
  }

 private:
  struct Job {
    std::function<void()> work, done, failed;
  };

  /// One of the threads wakes up, and takes the first job that there is then.
  void begin_one() {
    if (idle_ == 0 || jobs_.size() <= waking_) return;
    --idle_;
    ++waking_;
    const double busy = random_.chance(0.02) ? kBusy : 0;
    world_.after(simulation::seconds(random_.between(0, kBegins + busy)), [weak = weak_from_this()] {
      if (const auto self = weak.lock()) {
        self->world_.when_moving([weak] {
          if (const auto still = weak.lock(); still && !still->over_) still->work();
        });
      }
    });
  }

  void work() {
    --waking_;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    world_.crossing();
    bool well = false;
    const Duration waited = world_.in_worker([&] { well = guarded("a job of a worker", job.work); });
    world_.crossing();
    job.work = nullptr;
    const double busy = random_.chance(0.02) ? kBusy : 0;
    world_.after(
        waited + simulation::seconds(random_.between(0, kTakes + busy)),
        [weak = weak_from_this(), end = well ? std::move(job.done) : std::move(job.failed)]() mutable {
          if (const auto self = weak.lock(); self && !self->over_) self->hand_back(std::move(end));
        });
  }

  /// The loop takes it up when it does not stand still.
  void hand_back(std::function<void()> end) {
    ++idle_;
    loop_.post([weak = weak_from_this(), end = std::move(end)] {
      if (const auto self = weak.lock(); self && !self->over_) end();
    });
    begin_one();
  }

  Loop& loop_;
  World& world_ = World::current();
  unsigned idle_;
  std::size_t waking_ = 0;
  const bool finishes_;
  simulation::Random random_;
  std::deque<Job> jobs_;
  bool over_ = false;
};

}  // namespace

class Workers::Impl {
 public:
  Impl(Loop& loop, unsigned count, AtEnd at_end)
      : pool_(std::make_shared<Pool>(loop, count, at_end == AtEnd::Finish)) {}
  ~Impl() { pool_->end(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  Pool& pool() { return *pool_; }

 private:
  const std::shared_ptr<Pool> pool_;
};

Workers::Workers(Loop& loop, unsigned count, AtEnd at_end)
    : impl_(std::make_unique<Impl>(loop, count, at_end)) {}
Workers::~Workers() = default;

void Workers::submit(std::function<void()> work, std::function<void()> done, std::function<void()> failed) {
  impl_->pool().submit(std::move(work), std::move(done), std::move(failed));
}
void Workers::submit(std::function<void()> work, std::function<void()> done) {
  const auto either = std::make_shared<std::function<void()>>(std::move(done));
  impl_->pool().submit(std::move(work), [either] { (*either)(); }, [either] { (*either)(); });
}
void Workers::ask() {}
bool Workers::are_well(Duration) const {
  return true;
}

}  // namespace adit::loop
