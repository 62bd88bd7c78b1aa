#pragma once

#include <vector>

#include "alarms/facts.hpp"
#include "api/run_view.hpp"

namespace adit::api {

/// What the rules of alarms go by, of each row.
std::vector<alarms::Stream> streams_of(const std::vector<ActivityRow>& rows, Time now);

/// Puts into the view what is to be thought of each of its activities, and of all. Requires that
/// `facts.streams` is streams_of(view.activities).
void judge(RunView& view, const alarms::Facts& facts);

}  // namespace adit::api
