#include "queues/step_back.hpp"

#include <algorithm>

namespace adit::queues {

bool StepBack::shown_by(icd::Stamp stamp, Connection connection) {
  if (connection == 0) return false;
  const auto known = std::ranges::find(heard_, connection, &Heard::connection);
  const bool shown = shows(stamp, known == heard_.end() ? nullptr : &*known);
  if (shown) {
    heard_.clear();
    latest_.reset();
  } else if (known != heard_.end()) {
    heard_.erase(known);
  } else if (heard_.size() == kMostConnections) {
    heard_.erase(heard_.begin());
  }
  heard_.push_back({connection, stamp});
  late_ = latest_ && is_late(stamp, *latest_) ? std::optional(stamp) : std::nullopt;
  latest_ = std::max(latest_.value_or(stamp), stamp);
  return shown;
}

bool StepBack::shows(icd::Stamp stamp, const Heard* on_it) const {
  if (!latest_ || !is_late(stamp, *latest_)) return false;
  return (on_it != nullptr && is_late(stamp, on_it->last)) || (late_ && stamp > *late_);
}

}  // namespace adit::queues
