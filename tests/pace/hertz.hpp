#pragma once

#include <chrono>

#include "pace/rate_limit.hpp"

namespace adit::pace {

/// The rate of requests with that limit: the learned rate, at most `allowed`.
inline double hertz(const RateLimit& limit, double allowed) {
  const Duration learned = limit.learned_rate().spacing;
  return learned == Duration{} ? allowed : 1 / std::chrono::duration<double>{learned}.count();
}

}  // namespace adit::pace
