#include "queues/pipelining.hpp"

#include <algorithm>

#include "queues/queued_map.hpp"

namespace adit::queues {

bool in_any_order(const QueuedMap& one, const QueuedMap& other) {
  if (Sender::of(one.map) != Sender::of(other.map)) return true;
  return !one.map.is_grid() && !one.is_whole && !other.is_whole;
}

/// The first map that goes ahead is a trial: until it is accepted, no other map goes ahead.
bool Pipelining::may_go(const QueuedMap& next, const Before& before, Instant now) const {
  if (taken_ < well_ || now > before.arrived + kLate) return false;
  if (before.went_ahead && !tried_) return false;
  if (before.map.trial.failures > 0 || next.trial.failures > 0) return false;
  return in_any_order(next, before.map);
}

void Pipelining::taken(bool ahead) {
  taken_ = std::min(taken_ + 1, kMostWell);
  if (!ahead) return;
  tried_ = true;
  well_ = kWell;
}

void Pipelining::failed(bool two) {
  taken_ = 0;
  tried_ = false;
  if (two) well_ = std::min(well_ * 2, kMostWell);
}

}  // namespace adit::queues
