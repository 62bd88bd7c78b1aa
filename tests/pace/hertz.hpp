#pragma once

#include <chrono>

#include "pace/rate_limit.hpp"

namespace adit::pace {

/// How often a limit asks that is allowed so much: what it learned, which is never more than that.
inline double hertz(const RateLimit& limit, double allowed) {
  const Duration learned = limit.learned().spacing;
  return learned == Duration{} ? allowed : 1 / std::chrono::duration<double>{learned}.count();
}

}  // namespace adit::pace
