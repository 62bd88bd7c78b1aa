#include "loop/loop.hpp"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <systemd/sd-event.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "loop/file_descriptor.hpp"

namespace adit::loop {
namespace {

/// Timers are at most this late. The default of sd-event is 250 ms, to save power.
constexpr std::uint64_t kAccuracyUsec = 1000;
constexpr std::uint64_t kNever = UINT64_MAX;
constexpr std::chrono::milliseconds kReadTogether{1};  // the largest time between reading two clocks

/// Ends the process if sd-event fails (no memory, an unwatchable descriptor). systemd restarts it.
void require_success(int result, const char* doing) {
  if (result >= 0) return;
  std::fprintf(stderr, "event loop: %s: %s\n", doing, std::strerror(-result));
  std::abort();
}

/// Rounded up, so that a timer is never early.
std::uint64_t to_usec(Instant when) {
  const auto since_boot = std::chrono::ceil<std::chrono::microseconds>(when.time_since_epoch()).count();
  return static_cast<std::uint64_t>(std::max<std::int64_t>(since_boot, 0));
}

}  // namespace

double system_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

struct Source::State : std::enable_shared_from_this<Source::State> {
  std::function<void(std::uint32_t)> call;
  sd_event_source* source = nullptr;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { end(); }

  void end() { source = sd_event_source_disable_unref(source); }

  /// Keeps the callback alive, because it may destroy its own Source. An exception ends the process.
  static int run(void* userdata, std::uint32_t events) noexcept {
    const auto alive = static_cast<State*>(userdata)->weak_from_this().lock();
    alive->call(events);
    return 0;
  }
  static int ready(sd_event_source*, int, std::uint32_t events, void* userdata) {
    return run(userdata, events);
  }
  static int on_expired(sd_event_source*, std::uint64_t, void* userdata) { return run(userdata, 0); }
  static int came(sd_event_source*, const signalfd_siginfo*, void* userdata) { return run(userdata, 0); }
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
  require_success(sd_event_source_set_io_events(state_->source, events), "wait_for");
  require_success(sd_event_source_set_enabled(state_->source, events == 0 ? SD_EVENT_OFF : SD_EVENT_ON),
                  "wait_for");
}

void Source::call_at(Instant when) {
  require_success(sd_event_source_set_time(state_->source, to_usec(when)), "call_at");
  require_success(sd_event_source_set_enabled(state_->source, SD_EVENT_ONESHOT), "call_at");
}

void Source::cancel() {
  require_success(sd_event_source_set_enabled(state_->source, SD_EVENT_OFF), "cancel");
}

class Loop::Impl {
 public:
  Impl() : wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    require_success(wake ? 0 : -errno, "eventfd");
    require_success(sd_event_new(&event), "sd_event_new");
    require_success(sd_event_add_io(event, nullptr, wake.get(), EPOLLIN, &Impl::on_woken, this),
                    "watching posts");
  }
  ~Impl() { sd_event_unref(event); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void turn(std::uint64_t most_usec) {
    thread = std::this_thread::get_id();
    const int result = sd_event_run(event, own_posts ? 0 : most_usec);
    if (result != -EINTR) require_success(result, "sd_event_run");
    if (std::exchange(own_posts, false)) run_posted();
  }

  static int on_woken(sd_event_source*, int fd, std::uint32_t, void* userdata) {
    eventfd_t count = 0;
    ::eventfd_read(fd, &count);
    static_cast<Impl*>(userdata)->run_posted();
    return 0;
  }

  void run_posted() noexcept {
    std::vector<std::function<void()>> tasks;
    {
      const std::lock_guard lock(mutex);
      tasks.swap(posted);
    }
    running_tasks = true;
    for (auto& task : tasks) {
      task();
      task = nullptr;  // frees the task's data before the next task runs
    }
    running_tasks = false;
  }

  const Instant started = std::chrono::steady_clock::now();
  double stamp_at_start = system_now();
  WallClock wall{stamp_at_start, started};
  FileDescriptor wake;
  sd_event* event = nullptr;
  std::atomic<std::thread::id> thread{};  // the loop's thread, once it has run
  bool stopping = false;
  bool running_tasks = false;
  bool own_posts = false;  // the loop's thread posted, and the eventfd was not written
  std::mutex mutex;
  std::vector<std::function<void()>> posted;
};

Loop::Loop() : impl_(std::make_unique<Impl>()) {}
Loop::~Loop() = default;

Instant Loop::now() const {
  return std::chrono::steady_clock::now();
}
double Loop::stamp_now() const {
  return impl_->stamp_at_start + std::chrono::duration<double>(now() - impl_->started).count();
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
  const Instant before = now();
  const double system = system_now();
  const Instant after = now();
  // The thread was paused between the two readings; the next second's call decides.
  return after - before > kReadTogether ? 0 : impl_->wall.update(system, after, system_is_right);
}

Source Loop::watch(int fd, std::uint32_t events, std::function<void(std::uint32_t)> ready) {
  auto state = std::make_shared<Source::State>();
  state->call = std::move(ready);
  require_success(
      sd_event_add_io(impl_->event, &state->source, fd, events, &Source::State::ready, state.get()),
      "watching a descriptor");
  if (events == 0)
    require_success(sd_event_source_set_enabled(state->source, SD_EVENT_OFF), "watching a descriptor");
  return Source(std::move(state));
}

Source Loop::timer(std::function<void()> expired) {
  auto state = std::make_shared<Source::State>();
  state->call = [call = std::move(expired)](std::uint32_t) { call(); };
  require_success(sd_event_add_time(impl_->event, &state->source, CLOCK_MONOTONIC, kNever, kAccuracyUsec,
                                    &Source::State::on_expired, state.get()),
                  "making a timer");
  require_success(sd_event_source_set_enabled(state->source, SD_EVENT_OFF), "making a timer");
  return Source(std::move(state));
}

Source Loop::signal(int number, std::function<void()> came) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, number);
  require_success(-pthread_sigmask(SIG_BLOCK, &set, nullptr), "blocking a signal");
  auto state = std::make_shared<Source::State>();
  state->call = [call = std::move(came)](std::uint32_t) { call(); };
  require_success(
      sd_event_add_signal(impl_->event, &state->source, number, &Source::State::came, state.get()),
      "watching a signal");
  return Source(std::move(state));
}

void Loop::post(std::function<void()>&& task) {
  bool first = false;
  {
    const std::lock_guard lock(impl_->mutex);
    first = impl_->posted.empty();
    impl_->posted.push_back(std::move(task));  // moves `task` only after the allocation
  }
  if (!first) return;
  // A task posted from the loop's own thread runs at the end of the turn and needs no system call. A task
  // that a task posts takes its turn among the sockets.
  if (std::this_thread::get_id() == impl_->thread && !impl_->running_tasks) {
    impl_->own_posts = true;
  } else {
    ::eventfd_write(impl_->wake.get(), 1);  // cannot fail: the counter is far below its maximum
  }
}

void Loop::run() {
  while (!impl_->stopping) impl_->turn(kNever);
  impl_->stopping = false;
}
void Loop::stop() {
  impl_->stopping = true;
}

void Loop::turn(Duration most) {
  const auto usec = std::chrono::ceil<std::chrono::microseconds>(most).count();
  impl_->turn(static_cast<std::uint64_t>(std::max<std::int64_t>(usec, 0)));
}

}  // namespace adit::loop
