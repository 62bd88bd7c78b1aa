#pragma once

#include <optional>
#include <vector>

#include "alarms/facts.hpp"
#include "api/run_view.hpp"

namespace adit::api {

double seconds_since(Time at, Time now);  // at least 0

/// The age on page, command line, metrics and alarms: seconds since the robot posted the newest data that the
/// Command Post can have. std::nullopt if no data was delivered.
std::optional<double> age_of(const ActivityRow& row, Time now);

/// Input of the alarm rules, one for each row.
std::vector<alarms::Stream> streams_of(const std::vector<ActivityRow>& rows, Time now);

/// Computes ages, arrival, levels, words, standings and verdict from the view's other members. Requires that
/// `facts.streams` is streams_of(view.activities).
void add_verdicts(RunView& view, const alarms::Facts& facts);

}  // namespace adit::api
