#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "loop/loop.hpp"

namespace adit::loop {

/// How soon a job is to be done.
enum class Urgency : std::uint8_t {
  OnTheWay,  // a message, or the answer to one, waits for it
  CanWait,   // it is only looked at, or only freed
};

/// The jobs that wait for a few workers, and which of them is next. Reads no clock, and locks nothing.
///
/// Those of one urgency begin in the order in which they came. What is on the way goes before what can wait,
/// until that has waited for kPatience since it came, and since the last of its kind ended: then one has its
/// turn. So each begins after its number's patience at the latest, and what is on the way has all of that in
/// between. Where there are several workers, one is always free of what can wait.
template <class Job>
class JobQueue {
 public:
  static constexpr std::chrono::milliseconds kPatience{100};
  /// So long a job that can wait works, before it gives way to what came meanwhile.
  static constexpr std::chrono::milliseconds kTurn{10};

  struct Next {
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

  /// For a worker that is idle. Nothing: none waits, or enough of those that can are at work.
  std::optional<Next> take(Instant now) {
    const bool may_wait = !can_wait_.empty() && at_work_ < most_that_can_wait_;
    if (may_wait && (on_the_way_.empty() || has_waited_long(now))) {
      Next next{std::move(can_wait_.front().job), Urgency::CanWait};
      can_wait_.pop_front();
      ++at_work_;
      return next;
    }
    auto job = take_on_the_way();
    if (!job) return std::nullopt;
    return Next{std::move(*job), Urgency::OnTheWay};
  }

  /// For a worker amid a job that can wait, which works since `began` and gives way since `since`: the one to
  /// be done first. Nothing: it goes on.
  std::optional<Job> take_amid(Instant began, Instant since, Instant now) {
    if (since - began < kTurn || now - since >= kPatience) return std::nullopt;
    return take_on_the_way();
  }

  /// To be told of each that take() gave.
  void ended(Urgency urgency, Instant now) {
    if (urgency == Urgency::OnTheWay) return;
    --at_work_;
    last_ended_ = now;
  }

  /// Hands over all that wait, so that what they hold may be freed elsewhere.
  void hand_over_to(JobQueue& other) {
    std::swap(other.on_the_way_, on_the_way_);
    std::swap(other.can_wait_, can_wait_);
  }

  std::size_t size() const { return on_the_way_.size() + can_wait_.size(); }

 private:
  struct Patient {
    Job job;
    Instant came{};
  };

  std::optional<Job> take_on_the_way() {
    if (on_the_way_.empty()) return std::nullopt;
    std::optional<Job> job{std::move(on_the_way_.front())};
    on_the_way_.pop_front();
    return job;
  }
  bool has_waited_long(Instant now) const {
    return now - std::max(can_wait_.front().came, last_ended_) >= kPatience;
  }

  const std::size_t most_that_can_wait_;
  std::size_t at_work_ = 0;  // of those that can wait
  std::deque<Job> on_the_way_;
  std::deque<Patient> can_wait_;
  Instant last_ended_{};  // of those that can wait
};

}  // namespace adit::loop
