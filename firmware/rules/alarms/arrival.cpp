#include "alarms/arrival.hpp"

#include <algorithm>

#include "icd/status.hpp"

namespace adit::alarms {

using facts::Arrival;
using facts::Level;

Arrival arrival_of(const facts::ActivityRow& row, double turn, bool silent) {
  const double age = row.age.value_or(0), late = kLateAfter + turn;
  const bool throttled = row.last_status == icd::kTooManyRequests;
  if (row.last_status >= 400 && row.last_status < 500 && !throttled) return Arrival::Refused;
  if (age > std::max(kStuckAfter, 3 * late)) return Arrival::NotArriving;
  if (throttled) return Arrival::Throttled;
  if (!row.last_sentence.empty()) return age > kFailingAfter ? Arrival::NotArriving : Arrival::Failing;
  if (silent) return Arrival::Silent;
  if (age > late) return Arrival::Late;
  if (!row.last_forwarded) return Arrival::NotYet;
  if (row.age) return Arrival::Arriving;
  return row.heard.value_or(0) > kQuietAfter ? Arrival::Quiet : Arrival::UpToDate;
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

namespace {

constexpr double kTick = 1.5;  // seconds: two statuses closer than this may show the same whole second

constexpr codec::Member kShown[] = {
    codec::member<&ShownClock::seconds>("seconds", "seconds of the run, now"),
    codec::member<&ShownClock::age>("age", "seconds since the status that the clock comes from"),
    codec::member<&ShownClock::runs>("runs", "whether the clock goes on between two statuses"),
    codec::member<&ShownClock::old>(
        "old", "whether the status is no longer fresh: a clock that runs is then an estimate"),
};

}  // namespace

constexpr codec::Row ShownClock::kRow = codec::complete<ShownClock>({"RunClock", kShown, "The run's clock."});

void RunClock::on_status(double shows, double now) {
  bool runs = shows > 0;
  if (heard_ && shows == heard_->shows) runs = heard_->runs && now - heard_->at <= kTick;
  heard_ = {.shows = shows, .at = now, .runs = runs};
}

std::optional<ShownClock> RunClock::at(double now) const {
  if (!heard_) return std::nullopt;
  const double age = std::max(0.0, now - heard_->at);
  return ShownClock{.seconds = heard_->shows + (heard_->runs ? age : 0),
                    .age = age,
                    .runs = heard_->runs,
                    .old = age > kStatusOldAfter};
}

}  // namespace adit::alarms
