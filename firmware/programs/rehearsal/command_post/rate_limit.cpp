#include "rehearsal/command_post/rate_limit.hpp"

#include <algorithm>

namespace adit::rehearsal {

bool RateLimit::too_soon(const Request& request, Clock::time_point now) const {
  const double tolerance = counted_ == Counted::Decoded ? 1 : 0.95;
  if (hz_ <= 0 || !last_) return false;
  const Clock::time_point comes = counted_ == Counted::LastBytes ? request.whole
                                  : counted_ == Counted::Decoded ? now
                                                                 : request.at;
  return comes - *last_ < std::chrono::duration<double>(tolerance / hz_);
}

void RateLimit::count(const Request& request, Clock::time_point now) {
  const Clock::time_point counts = counted_ == Counted::Starts      ? request.at
                                   : counted_ == Counted::LastBytes ? request.whole
                                                                    : now;
  last_ = last_ ? std::max(*last_, counts) : counts;
}

}  // namespace adit::rehearsal
