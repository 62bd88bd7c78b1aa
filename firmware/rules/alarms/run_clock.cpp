#include "alarms/run_clock.hpp"

#include <algorithm>

#include "alarms/arrival.hpp"

namespace adit::alarms {
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

constexpr codec::Row ShownClock::kRow = {"RunClock", kShown, "The run's clock."};

void RunClock::heard(double shows, double now) {
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
