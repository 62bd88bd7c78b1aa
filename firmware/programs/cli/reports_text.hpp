#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/run_view.hpp"
#include "cli/table.hpp"

namespace adit::cli {

/// Whether the report stays in its state until the operator decides.
bool needs_the_operator(const api::ReportRow& report);
/// Whether the report is in a final state.
bool is_finished(const api::ReportRow& report);

/// The report's state for people: "held", "in doubt", "in doubt, asking", "held, to be sent".
std::string life_of(const api::ReportRow& report);
Tone tone_of(const api::ReportRow& report);
/// The Command Post's answer in words: "scored", "found out, scored", "error 422", or "".
std::string said_of(const api::ReportRow& report);
/// "+1", "0", or "" if unknown.
std::string gained_by(const api::ReportRow& report);

/// The subcommands of `adit reports` that apply to the report's state.
std::vector<std::string_view> verbs_for(const api::ReportRow& report);

/// Reports that `adit reports` leaves out.
struct OmittedReports {
  std::size_t older = 0;  // than those of --last
  std::size_t of_other_runs = 0;
};

/// The output of `adit reports`.
std::string reports_text(const std::vector<api::ReportRow>& reports, const OmittedReports& rest,
                         api::Time now, bool colour);

/// The output of `adit reports show`.
std::string report_text(const api::ReportDetail& detail, bool colour);

}  // namespace adit::cli
