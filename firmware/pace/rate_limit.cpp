#include "pace/rate_limit.hpp"

#include <algorithm>

namespace adit::pace {
namespace {

/// Between two requests at `hertz`; a rate too low to matter in any run does not overflow.
Duration spacing(double hertz) {
  using Seconds = std::chrono::duration<double>;
  constexpr Seconds kLongest = std::chrono::hours{24};
  return std::chrono::duration_cast<Duration>(std::min(Seconds{1 / hertz}, kLongest));
}

}  // namespace

void RateLimit::sent(Instant now) {
  next_ = std::max(next_, now + spacing(learned_));
}

void RateLimit::taken(Instant now) {
  learned_ = std::min(allowed_, learned_ * 1.1);
  next_ = now + spacing(learned_);
}

void RateLimit::throttled(Instant now, std::optional<std::chrono::seconds> retry_after) {
  learned_ = std::max(std::min(allowed_, kSlowest), learned_ / 2);
  const auto asked = std::clamp(retry_after.value_or(std::chrono::seconds{0}), {}, kLongestPause);
  next_ = now + std::max<Duration>(spacing(learned_), asked);
}

}  // namespace adit::pace
