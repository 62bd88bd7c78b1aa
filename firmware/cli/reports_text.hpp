#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/run_view.hpp"
#include "cli/words.hpp"

namespace adit::cli {

/// Whether the report stays in its state until the operator decides.
bool needs_the_operator(const api::ReportRow& report);
/// Whether the report is in a final state.
bool is_finished(const api::ReportRow& report);

/// The report's state as people read it: "held", "in doubt", "in doubt, asking".
std::string life_of(const api::ReportRow& report);
Tone tone_of(const api::ReportRow& report);
/// The Command Post's answer in words: "scored", "found out, scored", "error 422", or "".
std::string said_of(const api::ReportRow& report);
/// "+1", "0", or "" where it is not known.
std::string gained_by(const api::ReportRow& report);

/// The subcommands of `adit reports` that apply to the report: the transitions from its state.
std::vector<std::string_view> verbs_for(const api::ReportRow& report);

/// How many reports `adit reports` leaves out.
struct NotListed {
  std::size_t older = 0;  // than the reports of --last
  std::size_t of_other_runs = 0;
};

/// What `adit reports` prints.
std::string reports_text(const std::vector<api::ReportRow>& reports, const NotListed& rest, api::Time now,
                         bool colour);

/// What `adit reports show` prints.
std::string report_text(const api::ReportDetail& detail, bool colour);

}  // namespace adit::cli
