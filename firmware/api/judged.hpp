#pragma once

#include <vector>

#include "alarms/facts.hpp"
#include "api/run_view.hpp"

namespace adit::api {

/// How old everything is that the faces show, and that the rules of alarms go by.
double seconds_since(Time at, Time now);

/// What the rules of alarms go by, of each row.
std::vector<alarms::Stream> streams_of(const std::vector<ActivityRow>& rows, Time now);

/// Puts into the view how old each of its activities and robots is, and what is to be thought of them.
/// Requires that `facts.streams` is streams_of(view.activities).
void judge(RunView& view, const alarms::Facts& facts);

}  // namespace adit::api
