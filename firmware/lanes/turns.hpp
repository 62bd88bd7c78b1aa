#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>

namespace adit::lanes {

/// When a sender's next message goes: round by round, and within a round in order. The smaller goes first.
struct Turn {
  std::uint64_t round = 0, place = 0;
  friend auto operator<=>(const Turn&, const Turn&) = default;
};

/// Deficit round robin (Shreedhar and Varghese, 1995) in which a message goes first and is paid for after: it
/// costs its sender one round for each slot that it took. So of N senders that wait, each is served once
/// before any other is served twice, whatever they offer. Who waits for nothing saves up no turns, and who
/// comes back has still to pay.
class Turns {
 public:
  /// Bounds what one message can cost, in slots.
  static constexpr std::uint64_t kMostSlots = 64;

  /// The turn of a sender that begins to wait, after all who wait already; `last`: what served() said of it.
  Turn joins(Turn last) { return {std::max(last.round, round_ + 1), ++places_}; }
  /// Its turn has come: when it comes next, if it goes on waiting.
  Turn served(Turn turn) {
    round_ = std::max(round_, turn.round);
    return {round_ + 1, ++places_};
  }
  /// Its message took so many slots beyond the first.
  Turn owes(Turn next, std::uint64_t slots) const {
    return {std::min(next.round + std::min(slots, kMostSlots), round_ + 1 + kMostSlots), next.place};
  }
  /// Whether a sender that waits for nothing has still to pay; if not, it can be forgotten.
  bool has_to_pay(Turn turn) const { return turn.round > round_ + 1; }

 private:
  std::uint64_t round_ = 0;  // that goes on
  std::uint64_t places_ = 0;
};

}  // namespace adit::lanes
