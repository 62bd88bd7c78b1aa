#include "lanes/stamps.hpp"

#include <algorithm>

namespace adit::lanes {

icd::Stamp StampShift::shift(const std::string& sender, std::optional<icd::Stamp> stamp, double now) {
  if (!stamp || *stamp == 0) return std::max(now, latest_of(sender));
  const auto [found, is_new] = senders_.try_emplace(sender);
  Clock& clock = found->second;
  clock.used = ++uses_;
  // A difference is taken first: a stamp far from the gateway's would lose its fractions in a sum.
  icd::Stamp shifted = clock.ours + (*stamp - clock.theirs);
  if (is_new || *stamp < clock.latest - kJump || shifted > now + kJump) {
    clock.theirs = clock.latest = *stamp;
    clock.ours = shifted = now;
  }
  clock.latest = std::max(clock.latest, *stamp);
  if (senders_.size() > kMostSenders) forget_the_most_silent();
  return std::max(shifted, 0.0);  // ICD 6.2: a stamp is never negative
}

icd::Stamp StampShift::latest_of(const std::string& sender) const {
  const auto known = senders_.find(sender);
  if (known == senders_.end()) return 0;
  const Clock& clock = known->second;
  return clock.ours + (clock.latest - clock.theirs);
}

void StampShift::forget_the_most_silent() {
  senders_.erase(
      std::ranges::min_element(senders_, {}, [](const auto& sender) { return sender.second.used; }));
}

icd::Stamp StampOrder::next(icd::Stamp stamp) {
  return last_ = std::max(last_, stamp);
}

}  // namespace adit::lanes
