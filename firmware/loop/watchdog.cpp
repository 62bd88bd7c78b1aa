#include "loop/watchdog.hpp"

#include <utility>

namespace adit::loop {

Watchdog::Watchdog(Loop& loop, Duration within, std::function<void()> feed, Duration longest_job)
    : loop_(loop),
      every_(within / 4),
      longest_job_(longest_job),
      feed_(std::move(feed)),
      due_(loop.timer([this] { look(); })) {
  look();
}

void Watchdog::ask_also(Workers* workers) {
  workers_ = workers;
  if (workers_ != nullptr) workers_->ask();
}

/// Whoever has not answered for a whole round is not asked again before it has.
void Watchdog::look() {
  if (workers_ == nullptr) {
    feed_();
  } else if (workers_->are_well(longest_job_)) {
    feed_();
    workers_->ask();
  }
  due_.call_at(loop_.now() + every_);
}

}  // namespace adit::loop
