#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <random>

#include "pace/backoff.hpp"
#include "pace/rate_limit.hpp"

namespace adit::gateway {

/// When one URI may be asked next: its rate limit, and its back-off after failures.
class UriPace {
 public:
  UriPace(double hertz, std::mt19937_64& random)
      : rate_(hertz),
        backoff_(std::chrono::milliseconds(500), std::chrono::milliseconds(10000)),
        random_(random) {}

  pace::Instant ready() const { return std::max(rate_.next(), retry_at_); }

  void sent(pace::Instant now) { rate_.sent(now); }
  void taken(pace::Instant now) {
    rate_.taken(now);
    backoff_.succeeded();
  }
  void throttled(pace::Instant now, std::optional<std::chrono::seconds> retry_after) {
    rate_.throttled(now, retry_after);
  }
  void failed(pace::Instant now) {
    retry_at_ = now + backoff_.failed(std::uniform_real_distribution<double>(0, 1)(random_));
  }

  /// What failed may well succeed now.
  void link_is_back() {
    backoff_.succeeded();
    retry_at_ = {};
  }

 private:
  pace::RateLimit rate_;
  pace::Backoff backoff_;
  pace::Instant retry_at_{};
  std::mt19937_64& random_;
};

}  // namespace adit::gateway
