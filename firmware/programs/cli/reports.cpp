#include <algorithm>

#include "api/run_view.hpp"
#include "cli/handlers.hpp"
#include "cli/reports_text.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

/// Default: reports of the present run, and unfinished ones of other runs.
bool is_listed(const api::ReportRow& report, const Options& options, std::int64_t present) {
  if (options.all_runs) return true;
  return options.run ? report.run == *options.run : report.run == present || !is_finished(report);
}

}  // namespace

Result<Outcome> list_reports(const Call& call) {
  const Options& options = call.options;
  const auto run = ADIT_TRY(fetch<api::RunView>(call.adit, "/adit/run"));
  auto told = ADIT_TRY(fetch<std::vector<api::ReportRow>>(call.adit, "/adit/reports"));

  std::vector<api::ReportRow>& rows = told.row;
  const Exit exit = std::ranges::any_of(rows, needs_the_operator) ? Exit::Attention : Exit::Fine;
  const std::size_t others = std::erase_if(
      rows, [&](const api::ReportRow& row) { return !is_listed(row, options, run.row.run_number); });
  std::ranges::reverse(rows);  // newest first
  const auto all = static_cast<std::int64_t>(rows.size()), shown = std::min(all, options.last.value_or(all));
  rows.resize(static_cast<std::size_t>(shown));
  const OmittedReports rest{.older = static_cast<std::size_t>(all - shown), .of_other_runs = others};
  return printed(call, codec::to_json(rows), reports_text(rows, rest, run.row.now, call.console.colour),
                 exit);
}

Result<Outcome> show_report(const Call& call) {
  return show<api::ReportDetail>(
      call, "/adit/reports/" + std::to_string(call.options.numbers.front()), report_text,
      [](const api::ReportDetail& detail) { return !needs_the_operator(detail.row); });
}

Result<Outcome> export_reports(const Call& call) {
  const bool json = call.options.json;
  const auto text = ADIT_TRY(get(call.adit, json ? "/adit/reports" : "/adit/reports.csv"));
  return printed(call, text, text);
}

}  // namespace adit::cli
