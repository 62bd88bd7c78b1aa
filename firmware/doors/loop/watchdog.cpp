#include "loop/watchdog.hpp"

#include <algorithm>
#include <utility>

namespace adit::loop {

Watchdog::Watchdog(Loop& loop, Duration within, std::function<void()> feed)
    : loop_(loop), every_(within / 4), feed_(std::move(feed)), due_(loop.timer([this] { check(); })) {
  check();
}

void Watchdog::watch_workers(std::vector<Workers*> workers) {
  workers_ = std::move(workers);
  ask();
}

void Watchdog::ask() {
  for (Workers* const each : workers_) each->ask();
}

/// A worker that has not answered for a whole round is not asked again before it answers.
void Watchdog::check() {
  due_.call_at(loop_.now() + every_);
  if (!std::ranges::all_of(workers_, [](Workers* each) { return each->are_responsive(kLongestJob); })) return;
  feed_();
  ask();
}

JobWatch::JobWatch(Loop& loop, std::function<void()> overruns)
    : loop_(loop), overruns_(std::move(overruns)), due_(loop.timer([this] { check(); })) {}

std::function<void()> JobWatch::begin() {
  started_ = std::make_shared<std::atomic<Instant>>();
  due_.call_at(loop_.now() + Watchdog::kLongestJob);
  return [&loop = loop_, started = started_] { *started = loop.now(); };
}

/// Other jobs may have run before it.
void JobWatch::check() {
  const Instant started = *started_, now = loop_.now();
  const Instant latest = (started == Instant() ? now : started) + Watchdog::kLongestJob;
  if (now < latest) return due_.call_at(latest);
  overruns_();
}

}  // namespace adit::loop
