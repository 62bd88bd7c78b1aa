#pragma once

#include "dispatch/mapping_verdict.hpp"
#include "dispatch/report.hpp"

namespace adit::dispatch {

/// What an answer to a report means for its life (the table in this room's README). A 2xx whose body says
/// nothing of a report may be anybody's (a captive portal's, a proxy's), so may a refusal that is a page, and
/// a 3xx, 408 or 5xx may come from something in between after the Command Post has recorded it: all these are
/// Lost.
ReportEvent event_of(int status, bool tells_of_a_report, Body body);

/// What an answered or reconciled report did to the run.
struct Effect {
  bool scored = false;  // it used up one of the allotment
  bool again = false;   // the run was not being scored (admin stop, not started): it is worth posting again
  std::int64_t points = 0;
};
/// Of an answer.
Effect effect_of(const icd::ReportReply& reply);
/// Of the report's stored answer; nothing of the above where it was not recorded.
Effect effect_of(const Report& report);

}  // namespace adit::dispatch
