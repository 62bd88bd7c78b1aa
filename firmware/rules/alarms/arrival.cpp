#include "alarms/arrival.hpp"

#include <algorithm>

namespace adit::alarms {
namespace {

constexpr int kTooMany = 429;

}  // namespace

Arrival arrival_of(const Stream& stream, double turn, bool silent) {
  const double behind = stream.behind.value_or(0), late = kLateAfter + turn;
  const bool throttled = stream.last_status == kTooMany;
  if (stream.last_status >= 400 && stream.last_status < 500 && !throttled) return Arrival::Refused;
  if (behind > std::max(kStuckAfter, 3 * late)) return Arrival::NotArriving;
  if (throttled) return Arrival::Throttled;
  if (stream.failed) return behind > kFailingAfter ? Arrival::NotArriving : Arrival::Failing;
  if (silent) return Arrival::Silent;
  if (behind > late) return Arrival::Late;
  if (!stream.forwarded) return Arrival::NotYet;
  if (stream.behind) return Arrival::Arriving;
  return *stream.forwarded > kQuietAfter ? Arrival::Quiet : Arrival::UpToDate;
}

Level level_of(Arrival arrival) {
  switch (arrival) {
    case Arrival::UpToDate:
    case Arrival::Arriving:
      return Level::Good;
    case Arrival::NotYet:
    case Arrival::Late:
    case Arrival::Throttled:
    case Arrival::Failing:
      return Level::Wait;
    case Arrival::NotArriving:
    case Arrival::Refused:
    case Arrival::Silent:
      return Level::Bad;
    case Arrival::Quiet:
      break;
  }
  return Level::Quiet;
}

}  // namespace adit::alarms
