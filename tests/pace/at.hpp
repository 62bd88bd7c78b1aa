#pragma once

#include "pace/rate_limit.hpp"

namespace adit::pace {

/// Seconds after the beginning.
inline Instant at(double s) {
  return Instant{std::chrono::duration_cast<Duration>(std::chrono::duration<double>{s})};
}

}  // namespace adit::pace
