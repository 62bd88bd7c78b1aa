#include "lanes/stamps.hpp"

#include <algorithm>
#include <cmath>

namespace adit::lanes {

icd::Stamp StampShift::shift(const std::string& sender, std::optional<icd::Stamp> stamp, double now,
                             Connection connection) {
  if (!stamp || *stamp == 0) return std::max(now, latest_of(sender));
  const auto [found, is_new] = senders_.try_emplace(sender);
  Clock& clock = found->second;
  clock.used = ++uses_;
  // A difference is taken first: a stamp far from the gateway's would lose its fractions in a sum.
  icd::Stamp shifted = clock.ours + (*stamp - clock.theirs);
  const bool set_back = clock.step_back.shown_by(*stamp, connection);
  if (is_new || set_back || *stamp < clock.latest - kJump || shifted > now + kJump) {
    shifted = is_new ? now : std::max(now, clock.latest_given());
    clock.ours = shifted;
    clock.theirs = clock.latest = *stamp;
  }
  clock.latest = std::max(clock.latest, *stamp);
  if (senders_.size() > kMostSenders) forget_the_most_silent();
  return std::max(shifted, 0.0);  // ICD 6.2: a stamp is never negative
}

icd::Stamp StampShift::latest_of(const std::string& sender) const {
  const auto known = senders_.find(sender);
  return known == senders_.end() ? 0 : known->second.latest_given();
}

const SenderClock* StampShift::clock_of(const std::string& sender) const {
  const auto known = senders_.find(sender);
  return known == senders_.end() ? nullptr : &known->second;
}

std::vector<std::pair<std::string, SenderClock>> StampShift::clocks() const {
  std::vector<std::pair<std::uint64_t, const std::string*>> by_use;
  by_use.reserve(senders_.size());
  for (const auto& [sender, clock] : senders_) by_use.emplace_back(clock.used, &sender);
  std::ranges::sort(by_use);
  std::vector<std::pair<std::string, SenderClock>> clocks;
  clocks.reserve(by_use.size());
  for (const auto& [used, sender] : by_use) clocks.emplace_back(*sender, senders_.at(*sender));
  return clocks;
}

std::optional<double> StampShift::told(double now, double from, double until) const {
  std::optional<double> earliest;
  for (const auto& [sender, clock] : senders_) {
    const double silent = now - clock.latest_given();
    if (clock.latest - clock.theirs < kSpeaks || std::abs(silent) > kSpeaks) continue;
    const double shows = clock.latest + silent;
    if (!(shows >= from && shows < until)) continue;
    earliest = std::min(earliest.value_or(shows), shows);
  }
  return earliest;
}

void StampShift::carry_on(const std::string& sender, const SenderClock& clock) {
  senders_[sender] = Clock{clock, ++uses_, {}};
  if (senders_.size() > kMostSenders) forget_the_most_silent();
}

void StampShift::forget_the_most_silent() {
  senders_.erase(
      std::ranges::min_element(senders_, {}, [](const auto& sender) { return sender.second.used; }));
}

icd::Stamp StampOrder::next(icd::Stamp stamp) {
  return last_ = std::max(last_, stamp);
}

}  // namespace adit::lanes
