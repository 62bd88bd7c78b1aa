#pragma once

#include "dispatch/mapping_verdict.hpp"
#include "dispatch/report.hpp"

namespace adit::dispatch {

/// The event that an answer causes (table in README.md). Lost: 2xx without a report, pages, 3xx, 408 and 5xx.
/// A proxy may send these after the Command Post has recorded the report. `is_unprocessed`: the server
/// redirects to the same path with or without a slash at its end, and did not process the report.
ReportEvent event_of(int status, bool tells_of_a_report, Body body, bool is_unprocessed = false);

/// True if the answer is about a report of another type, or over a metre away. Servers may round coordinates.
bool is_about_another(const icd::ReportReply& reply, const icd::ArtifactReport& report);

/// Effect of a report on the run.
struct Effect {
  bool scored = false;                     // it used up one of the remaining reports
  bool again = false;                      // not scored (admin stop, run not started): worth posting again
  std::optional<std::int64_t> points = 0;  // nullopt: uncertain
};
Effect effect_of(const icd::ReportReply& reply);
/// From the report's stored answer. Effect{} if the report was not recorded. The points are uncertain if it
/// was found recorded with others, of which some scored, or if the answer is about another report.
Effect effect_of(const Report& report);

}  // namespace adit::dispatch
