#include "access/failures.hpp"

#include <algorithm>

namespace adit::access {

Duration Failures::begin(const std::string& address, Instant now) {
  make_room(now);
  Count& own = by_address_[address];
  const Duration left = std::max(wait(own, kFree, now), wait(all_, kFreeInAll, now));
  if (left > Duration::zero()) return left;
  own = {own.wrong + 1, now};
  all_ = {all_.wrong + 1, now};
  return Duration::zero();
}

void Failures::succeeded(const std::string& address) {
  by_address_.erase(address);
  all_.wrong = std::max(all_.wrong - 1, 0);
}

Duration Failures::wait(const Count& count, int free, Instant now) {
  if (count.wrong < free) return Duration::zero();
  const int doublings = std::min(count.wrong - free, 6);  // 64 s is more than the most
  const Duration pause = std::min<Duration>(kFirst * (1 << doublings), kMost);
  return std::max(count.last + pause - now, Duration::zero());
}

void Failures::make_room(Instant now) {
  const auto is_old = [now](const Count& count) { return now - count.last >= kForgotten; };
  if (is_old(all_)) all_ = {};
  std::erase_if(by_address_, [&](const auto& entry) { return is_old(entry.second); });
  if (by_address_.size() < kMostAddresses) return;
  by_address_.erase(
      std::ranges::min_element(by_address_, {}, [](const auto& entry) { return entry.second.last; }));
}

}  // namespace adit::access
