#include "loop/watchdog.hpp"

#include <algorithm>
#include <utility>

namespace adit::loop {

Watchdog::Watchdog(Loop& loop, Duration within, std::function<void()> feed)
    : loop_(loop), every_(within / 4), feed_(std::move(feed)), due_(loop.timer([this] { look(); })) {
  look();
}

void Watchdog::ask_also(std::vector<Workers*> workers) {
  workers_ = std::move(workers);
  ask();
}

void Watchdog::ask() {
  for (Workers* const each : workers_) each->ask();
}

/// A worker that has not answered for a whole round is not asked again before it answers.
void Watchdog::look() {
  due_.call_at(loop_.now() + every_);
  if (!std::ranges::all_of(workers_, [](Workers* each) { return each->are_well(kLongestJob); })) return;
  feed_();
  ask();
}

}  // namespace adit::loop
