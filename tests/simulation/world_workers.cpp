// Implements loop/workers.hpp in the simulated world: each job runs at once at a drawn time, and its end
// follows at a later one.
#include <algorithm>
#include <optional>
#include <utility>

#include "loop/guard.hpp"
#include "loop/workers.hpp"
#include "simulation/world.hpp"

namespace adit::loop {
namespace {

using simulation::World;

/// Seconds until a job begins, and that it takes. kBusy applies if the machine is busy.
constexpr double kBegins = 0.0005, kTakes = 0.004, kBusy = 0.15;

class Pool : public std::enable_shared_from_this<Pool> {
 public:
  Pool(Loop& loop, unsigned count, bool finishes)
      : loop_(loop),
        idle_(count == 0 ? 2 : count),
        finishes_(finishes),
        jobs_(idle_),
        random_(world_.random("workers " + std::to_string(world_.entropy()))) {}

  void submit(Urgency urgency, std::function<void()> work, std::function<void()> done,
              std::function<void()> failed) {
    jobs_.add({std::move(work), std::move(done), std::move(failed)}, urgency, loop_.now());
    begin_one();
  }

  void end() {
    over_ = true;
    while (auto next = finishes_ ? jobs_.pop(loop_.now()) : std::nullopt) {
      run_guarded("a job of a worker", next->job.work);
    }
    JobQueue<Job> dropped(1);
    jobs_.hand_over_to(dropped);
  }

 private:
  struct Job {
    std::function<void()> work, done, failed;
  };

  /// A thread wakes up and runs the next job in the queue.
  void begin_one() {
    if (idle_ == 0 || jobs_.size() <= waking_) return;
    --idle_;
    ++waking_;
    const double busy = random_.chance(0.02) ? kBusy : 0;
    world_.after(simulation::seconds(random_.uniform(0, kBegins + busy)), [weak = weak_from_this()] {
      if (const auto self = weak.lock()) {
        self->world_.when_moving([weak] {
          if (const auto still = weak.lock(); still && !still->over_) still->work();
        });
      }
    });
  }

  void work() {
    --waking_;
    auto next = jobs_.pop(loop_.now());
    if (!next) {  // enough deferrable jobs run; the next one that ends begins it
      ++idle_;
      return;
    }
    Job& job = next->job;
    world_.crossing();
    bool well = false;
    const Duration waited = world_.in_worker([&] { well = run_guarded("a job of a worker", job.work); });
    world_.crossing();
    job.work = nullptr;
    const double busy = random_.chance(0.02) ? kBusy : 0;
    world_.after(waited + simulation::seconds(random_.uniform(0, kTakes + busy)),
                 [weak = weak_from_this(), urgency = next->urgency,
                  end = well ? std::move(job.done) : std::move(job.failed)]() mutable {
                   if (const auto self = weak.lock(); self && !self->over_)
                     self->hand_back(urgency, std::move(end));
                 });
  }

  /// Runs `end` in the loop, when the process does not stand still.
  void hand_back(Urgency urgency, std::function<void()> end) {
    ++idle_;
    jobs_.on_ended(urgency, loop_.now());
    loop_.post([weak = weak_from_this(), end = std::move(end)] {
      const auto self = weak.lock();
      if (!self || self->over_) return;
      self->world_.job_ended();
      end();
    });
    begin_one();
  }

  Loop& loop_;
  World& world_ = World::current();
  unsigned idle_;
  std::size_t waking_ = 0;
  const bool finishes_;
  JobQueue<Job> jobs_;
  simulation::Random random_;
  bool over_ = false;
};

}  // namespace

class Workers::Impl {
 public:
  Impl(Loop& loop, unsigned count, ShutdownPolicy at_end)
      : pool_(std::make_shared<Pool>(loop, count, at_end == ShutdownPolicy::Finish)) {}
  ~Impl() { pool_->end(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  Pool& pool() { return *pool_; }

 private:
  const std::shared_ptr<Pool> pool_;
};

Workers::Workers(Loop& loop, unsigned count, ShutdownPolicy at_end)
    : impl_(std::make_unique<Impl>(loop, count, at_end)) {}
Workers::~Workers() = default;

void Workers::submit(Urgency urgency, std::function<void()> work, std::function<void()> done,
                     std::function<void()> failed) {
  impl_->pool().submit(urgency, std::move(work), std::move(done), std::move(failed));
}
void Workers::submit(Urgency urgency, std::function<void()> work, std::function<void()> done) {
  const auto either = std::make_shared<std::function<void()>>(std::move(done));
  impl_->pool().submit(urgency, std::move(work), [either] { (*either)(); }, [either] { (*either)(); });
}
void Workers::give_way() {}  // jobs take no time
void Workers::ask() {}
bool Workers::are_responsive(Duration) const {
  return true;
}

}  // namespace adit::loop
