#include "access/guesses.hpp"

#include <algorithm>

namespace adit::access {

Wait Guesses::begin(const Guesser& guesser, Instant now) {
  next_ = std::max(next_, now - kEach * (kSaved - 1));
  Count* const own = count_of(guesser, now);
  if (own == nullptr) return {next_ - now, true};
  own->asked = now;
  if (const Duration left = pause(*own, now); left > Duration::zero()) return {left, false};
  if (guesser.device != 0 || (guesser.at_box && own->wrong == 0)) {
    next_ += kEach;
  } else if (const Duration left = turn(*own, now); left > Duration::zero()) {
    return {left, true};
  }
  ++own->wrong;
  own->last = now;
  return {};
}

void Guesses::on_succeeded(const Guesser& guesser, Role role) {
  next_ -= kEach;
  const auto own = counts_.find(key_of(guesser));
  if (own == counts_.end()) return;
  own->second.wrong = role == Role::Operator ? 0 : std::max(own->second.wrong - 1, 0);
}

Guesses::Key Guesses::key_of(const Guesser& guesser) {
  return {guesser.device, guesser.device == 0 ? guesser.address : ""};
}

Duration Guesses::pause(const Count& count, Instant now) {
  if (count.wrong < kFree) return Duration::zero();
  const int doublings = std::min(count.wrong - kFree, 6);  // 64 s is more than kMost
  const Duration pause = std::min<Duration>(kFirst * (1 << doublings), kMost);
  return std::max(count.last + pause - now, Duration::zero());
}

/// Null if kMostGuessers clients wait for their turns and this one is no known device.
Guesses::Count* Guesses::count_of(const Guesser& guesser, Instant now) {
  std::erase_if(counts_, [now](const auto& each) { return now - each.second.asked >= kForgotten; });
  const Key key = key_of(guesser);
  if (const auto known = counts_.find(key); known != counts_.end()) return &known->second;
  if (counts_.size() >= kMostGuessers) {
    const auto waits = [now](const Count& count) { return count.turn && now - *count.turn <= kLate; };
    const auto longest_silent = std::ranges::min_element(
        counts_, {}, [&](const auto& each) { return std::pair(waits(each.second), each.second.asked); });
    if (waits(longest_silent->second) && guesser.device == 0) return nullptr;
    counts_.erase(longest_silent);
  }
  return &counts_[key];
}

/// The wait for its turn; zero: the turn is used now. Assigns a turn if it has none.
Duration Guesses::turn(Count& own, Instant now) {
  if (own.turn && now < *own.turn) return *own.turn - now;
  const std::optional<Instant> had = std::exchange(own.turn, std::nullopt);
  if (had && now - *had <= kLate) return Duration::zero();
  const Instant given = std::exchange(next_, next_ + kEach);
  if (given > now) own.turn = given;
  return std::max(given - now, Duration::zero());
}

}  // namespace adit::access
