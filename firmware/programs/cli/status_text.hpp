#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/run_view.hpp"
#include "cli/table.hpp"

namespace adit::cli {

/// Whether the report stays in its state until the operator decides.
bool needs_the_operator(const facts::ReportRow& report);
bool is_finished(const facts::ReportRow& report);

/// The report's state for people: "held", "in doubt", "in doubt, asking", "held, to be sent".
std::string report_state(const facts::ReportRow& report);
Tone tone_of(const facts::ReportRow& report);
/// The Command Post's answer in words: "scored", "found out, scored", "error 422", or "".
std::string outcome_text(const facts::ReportRow& report);
/// "+1", "0", or "" if unknown.
std::string gain_text(const facts::ReportRow& report);

/// The subcommands of `adit reports` that apply to the report's state.
std::vector<std::string_view> verbs_for(const facts::ReportRow& report);

/// Reports that `adit reports` leaves out.
struct OmittedReports {
  std::size_t older = 0;  // than those of --last
  std::size_t of_other_runs = 0;
};

/// The output of `adit reports`.
std::string reports_text(const std::vector<facts::ReportRow>& reports, const OmittedReports& rest,
                         api::Time now, bool colour);

/// The output of `adit reports show`.
std::string report_text(const api::ReportDetail& detail, bool colour);

Tone tone_of_level(facts::Level level);

/// The output of `adit status`.
std::string status_text(const api::RunView& view, bool colour);

/// A line with the time of day for each change between two views, or "".
std::string changes_text(const api::RunView& before, const api::RunView& now, bool colour);

/// The part of `text` that fits a screen of that size, without a final newline. Long lines are cut. The last
/// line says how many lines are missing. Colour sequences have no width.
std::string fit(std::string_view text, std::size_t rows, std::size_t columns);

}  // namespace adit::cli
