#pragma once

#include "dispatch/mapping_verdict.hpp"
#include "dispatch/report.hpp"

namespace adit::dispatch {

/// What an answer to a report means for its life (the table in this room's README). Lost are: a 2xx whose
/// body says nothing of a report and a refusal that is a page, which anybody may have sent (a captive portal,
/// a proxy); and a 3xx, 408 or 5xx, which something in between may have sent after the Command Post recorded
/// it.
ReportEvent event_of(int status, bool tells_of_a_report, Body body);

/// What an answered or reconciled report did to the run.
struct Effect {
  bool scored = false;  // it used up one of the remaining reports
  bool again = false;   // the run was not being scored (admin stop, not started): it is worth posting again
  std::int64_t points = 0;
};
/// Of an answer.
Effect effect_of(const icd::ReportReply& reply);
/// Of the report's stored answer; Effect{} if it was not recorded.
Effect effect_of(const Report& report);

}  // namespace adit::dispatch
