#include "dispatch/turn.hpp"

#include <algorithm>

namespace adit::dispatch {

Turn oldest_first(std::span<const Candidate> candidates, Instant now) {
  Turn turn;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (!candidate.oldest) continue;
    if (candidate.ready > now) {
      turn.wake = std::min(turn.wake.value_or(candidate.ready), candidate.ready);
    } else if (!turn.candidate || *candidate.oldest < *candidates[*turn.candidate].oldest) {
      turn.candidate = i;
    }
  }
  if (turn.candidate) turn.wake.reset();
  return turn;
}

Turn in_order(std::span<const Candidate> candidates, Instant now) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].oldest) continue;
    if (candidates[i].ready > now) return {.candidate = std::nullopt, .wake = candidates[i].ready};
    return {.candidate = i, .wake = std::nullopt};
  }
  return {};
}

}  // namespace adit::dispatch
