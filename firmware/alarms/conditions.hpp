#pragma once

#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/facts.hpp"

namespace adit::alarms {

/// All conditions, for page, lights, `adit` and metrics. A condition that follows from a larger cause is
/// counted in that cause's `hides` and is not listed. Order: bad, ask, wait.
std::vector<Condition> conditions_of(const Facts& facts);

/// Reports left at which the alarm starts.
inline constexpr std::int64_t kFewReports = 5;
/// Share of the queue's room at which the alarm starts.
inline constexpr double kNearlyFull = 0.8;
/// Free bytes on the ledger's disk below which the alarm starts.
inline constexpr std::uint64_t kLeastFree = 1u << 20;
/// Most reports of one state that have a condition each; more share one.
inline constexpr std::size_t kOneByOne = 10;

}  // namespace adit::alarms
