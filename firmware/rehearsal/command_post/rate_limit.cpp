#include "rehearsal/command_post/rate_limit.hpp"

namespace adit::rehearsal {

bool RateLimit::too_soon(Clock::time_point at) const {
  constexpr double tolerance = 0.95;
  if (hz_ <= 0 || !last_) return false;
  return at - *last_ < std::chrono::duration<double>(tolerance / hz_);
}

}  // namespace adit::rehearsal
