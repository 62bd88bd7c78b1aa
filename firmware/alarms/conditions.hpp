#pragma once

#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/facts.hpp"

namespace adit::alarms {

/// All that is not as it should be: the one list that page, lights, `adit` and metrics speak. What follows
/// from a larger cause is counted in its `hides`, and is not in the list. Bad before ask before wait.
std::vector<Condition> conditions_of(const Facts& facts);

/// Reports that are left, at most, where it is told.
inline constexpr std::int64_t kFewReports = 5;
/// Of the queue's room, where it is told.
inline constexpr double kNearlyFull = 0.8;
/// Bytes that are free on the disk of the ledger: where there are fewer it is told.
inline constexpr std::uint64_t kLeastFree = 1u << 20;
/// Reports of one state that are told of one by one; the others together.
inline constexpr std::size_t kOneByOne = 10;

}  // namespace adit::alarms
