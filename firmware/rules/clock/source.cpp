#include "clock/source.hpp"

namespace adit::clock {

std::optional<double> to_be_set(Source present, const Offer& offer, double now) {
  if (!(offer.time >= kEarliest && offer.time < kLatest)) return std::nullopt;
  const bool counts = offer.source > present || offer.source == Source::Operator;
  if (!counts) return std::nullopt;
  const bool ahead_alone = offer.source == Source::LastKnown || offer.source == Source::Robots;
  if (ahead_alone && offer.time <= now) return std::nullopt;
  if (offer.source == Source::Robots && offer.time > now + kRobotsMost) return std::nullopt;
  return offer.time;
}

}  // namespace adit::clock
