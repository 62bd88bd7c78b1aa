#include "pace/backoff.hpp"

#include <algorithm>

namespace adit::pace {

std::chrono::nanoseconds Backoff::failed(double random) {
  const std::chrono::duration<double, std::milli> wait = std::min(wait_, most_);
  wait_ = wait_ > most_ / 2 ? most_ : wait_ * 2;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(wait * (1 + random / 4));
}

}  // namespace adit::pace
