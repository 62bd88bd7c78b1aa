// Implements loop/loop.hpp and loop/file_descriptor.hpp in the simulated world.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "simulation/world.hpp"

namespace adit::loop {
namespace {

using simulation::World;

/// Maximum delay of sd-event's timers.
constexpr double kLatestTimer = 0.001;
/// A loop that turns this often without progress of time is a busy loop.
constexpr int kMostTurns = 100000;

}  // namespace

double system_now() {
  return World::current().stamp();
}

void close_descriptor(int fd) noexcept {
  if (!simulation::Network::is_simulated(fd)) {
    ::close(fd);
  } else if (World::current().process() != 0) {
    World::current().network().close(fd);
  }
}

struct Source::State : std::enable_shared_from_this<Source::State> {
  World& world = World::current();
  std::function<void(std::uint32_t)> call;
  std::uint64_t descriptor = 0, link = 0;  // of a watched descriptor or link
  std::uint64_t setting = 0;               // counts the settings of a timer
  simulation::Random* lateness = nullptr;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { end(); }

  void end() {
    if (descriptor != 0) world.descriptors().remove(std::exchange(descriptor, 0));
    if (link != 0) world.network().unwatch(std::exchange(link, 0));
    ++setting;
    over = true;
  }
  static void run(const std::weak_ptr<State>& weak, std::uint32_t events) {
    const auto alive = weak.lock();
    if (!alive || alive->over || alive->world.is_dead()) return;
    alive->call(events);
  }
  bool over = false;
};

Source::Source(std::shared_ptr<State> state) : state_(std::move(state)) {}
Source::Source(Source&&) noexcept = default;

Source& Source::operator=(Source&& other) noexcept {
  Source ended(std::move(other));
  std::swap(state_, ended.state_);
  return *this;
}

Source::~Source() {
  if (state_) state_->end();
}

void Source::wait_for(std::uint32_t events) {
  if (state_->descriptor != 0) state_->world.descriptors().wait_for(state_->descriptor, events);
  if (state_->link != 0) state_->world.network().wait_for(state_->link, events);
}

void Source::call_at(Instant when) {
  World& world = state_->world;
  const std::uint64_t setting = ++state_->setting;
  const auto late = simulation::seconds(state_->lateness->uniform(0, kLatestTimer));
  world.at(std::max(when, world.now()) + late, [weak = std::weak_ptr(state_), setting] {
    const auto alive = weak.lock();
    if (!alive || alive->setting != setting) return;
    alive->world.when_moving([weak, setting] {
      const auto still = weak.lock();
      if (still && still->setting == setting) State::run(still, 0);
    });
  });
}

void Source::cancel() {
  ++state_->setting;
}

class Loop::Impl {
 public:
  World& world = World::current();
  simulation::Random lateness = world.random("timers " + std::to_string(world.process()));
  Instant started = world.now();
  double stamp_at_start = world.stamp();
  WallClock wall{stamp_at_start, started};
  std::vector<std::function<void()>> posted;
  bool stopping = false;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { world.on_sigterm = nullptr; }

  double stamp_at(Instant instant) const {
    return stamp_at_start + std::chrono::duration<double>(instant - started).count();
  }

  /// Returns false if nothing can run before time advances.
  bool turn() {
    const auto tasks = std::exchange(posted, {});
    for (const auto& task : tasks) {
      if (!world.is_dead()) task();
    }
    const bool any = world.descriptors().dispatch(simulation::Descriptors::Whose::All);
    return world.network().dispatch() || any || !tasks.empty();
  }

  void run() {
    int turns = 0;
    while (!stopping) {
      if (world.is_dead()) throw simulation::Killed{};
      if (turn()) {
        if (++turns < kMostTurns) continue;
        std::fputs("the loop spins\n", stderr);
        std::abort();
      }
      turns = 0;
      if (!world.step()) std::abort();
    }
    stopping = false;
  }
};

Loop::Loop() : impl_(std::make_unique<Impl>()) {}
Loop::~Loop() = default;

Instant Loop::now() const {
  return impl_->world.now();
}
double Loop::stamp_now() const {
  return impl_->stamp_at(now());
}
void Loop::set_stamp(double now) {
  impl_->stamp_at_start += now - stamp_now();
}

double Loop::wall_now() const {
  return impl_->wall.now(now());
}
void Loop::set_wall(double now) {
  impl_->wall.set(now, this->now());
}
double Loop::wall_offset() const {
  return impl_->wall.offset();
}
double Loop::check_wall_clock(bool system_is_right) {
  return impl_->wall.update(impl_->world.stamp(), now(), system_is_right);
}

Source Loop::watch(int fd, std::uint32_t events, std::function<void(std::uint32_t)> ready) {
  auto state = std::make_shared<Source::State>();
  state->call = std::move(ready);
  const auto call = [weak = std::weak_ptr(state)](std::uint32_t came) { Source::State::run(weak, came); };
  if (simulation::Network::is_simulated(fd)) {
    state->link = impl_->world.network().watch(fd, events, call);
  } else {
    state->descriptor =
        impl_->world.descriptors().add(fd, events, call, simulation::Descriptors::Whose::Adits);
  }
  return Source(std::move(state));
}

Source Loop::timer(std::function<void()> expired) {
  auto state = std::make_shared<Source::State>();
  state->call = [call = std::move(expired)](std::uint32_t) { call(); };
  state->lateness = &impl_->lateness;
  return Source(std::move(state));
}

Source Loop::signal(int number, std::function<void()> came) {
  auto state = std::make_shared<Source::State>();
  state->call = [call = std::move(came)](std::uint32_t) { call(); };
  if (number == SIGTERM) {
    impl_->world.on_sigterm = [weak = std::weak_ptr(state)] { Source::State::run(weak, 0); };
  }
  return Source(std::move(state));
}

void Loop::post(std::function<void()>&& task) {
  impl_->posted.push_back(std::move(task));
}

void Loop::run() {
  impl_->run();
}
void Loop::stop() {
  impl_->stopping = true;
}
void Loop::turn(Duration) {
  if (!impl_->turn()) impl_->world.step();
}

}  // namespace adit::loop
