#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>

namespace adit::queues {

/// When a sender's next message is sent: by round, and within a round by place. The smaller turn goes first.
struct Turn {
  std::uint64_t round = 0, place = 0;
  friend auto operator<=>(const Turn&, const Turn&) = default;
};

/// Deficit round robin (Shreedhar and Varghese, 1995), paid afterwards: a message costs its sender one round
/// for each slot that it used. Of N senders with queued messages, each is served once before any is served
/// twice. A sender without messages saves no turns, and still pays when it comes back.
class Turns {
 public:
  /// The most that one message costs, in slots.
  static constexpr std::uint64_t kMostSlots = 64;

  /// The turn of a sender whose queue was empty, behind all others. `last`: its last result of served() or
  /// owes().
  Turn joins(Turn last) { return {std::max(last.round, round_ + 1), ++places_}; }
  /// Serves `turn`, and returns the sender's next turn.
  Turn served(Turn turn) {
    round_ = std::max(round_, turn.round);
    return {round_ + 1, ++places_};
  }
  /// The sender's next turn if its message used `slots` more than one slot.
  Turn owes(Turn next, std::uint64_t slots) const {
    return {std::min(next.round + std::min(slots, kMostSlots), round_ + 1 + kMostSlots), next.place};
  }
  /// Whether a sender with an empty queue still has to pay. If not, it can be forgotten.
  bool has_to_pay(Turn turn) const { return turn.round > round_ + 1; }

 private:
  std::uint64_t round_ = 0;  // the present one
  std::uint64_t places_ = 0;
};

}  // namespace adit::queues
