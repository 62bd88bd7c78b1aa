#pragma once

#include <optional>
#include <vector>

#include "alarms/facts.hpp"
#include "api/run_view.hpp"

namespace adit::api {

double seconds_since(Time at, Time now);  // at least 0

/// The age that page, command line, metrics and alarms show: seconds since the robot posted the newest data
/// that the Command Post can have. Nothing if none was delivered.
std::optional<double> age_of(const ActivityRow& row, Time now);

/// What the rules of alarms go by, of each row.
std::vector<alarms::Stream> streams_of(const std::vector<ActivityRow>& rows, Time now);

/// Sets ages, arrival, levels, words, standings and verdict by the view's other members.
/// Requires that `facts.streams` is streams_of(view.activities).
void judge(RunView& view, const alarms::Facts& facts);

}  // namespace adit::api
