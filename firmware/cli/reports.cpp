#include "cli/reports.hpp"

#include <algorithm>

#include "api/run_view.hpp"
#include "cli/actions.hpp"
#include "cli/ask.hpp"
#include "cli/reading.hpp"
#include "cli/report_text.hpp"
#include "cli/reports_text.hpp"
#include "cli/where.hpp"

namespace adit::cli {
namespace {

Exit exit_for(const std::vector<api::ReportRow>& reports) {
  return std::ranges::any_of(reports, needs_the_operator) ? Exit::Attention : Exit::Fine;
}

/// By default: the present run's, and the unfinished ones of other runs.
bool is_listed(const api::ReportRow& report, const Options& options, std::int64_t present) {
  if (options.all_runs) return true;
  return options.run ? report.run == *options.run : report.run == present || !is_finished(report);
}

Outcome list_reports(const Adit& adit, const Options& options, bool colour) {
  const auto run_json = get(adit, "/adit/run");
  if (!run_json) return unable(run_json.error());
  const auto run = read<api::RunView>(adit, *run_json);
  if (!run) return unable(run.error());
  const auto json = get(adit, "/adit/reports");
  if (!json) return unable(json.error());
  auto rows = read<std::vector<api::ReportRow>>(adit, *json);
  if (!rows) return unable(rows.error());

  const Exit exit = exit_for(*rows);
  const std::size_t others = std::erase_if(
      *rows, [&](const api::ReportRow& row) { return !is_listed(row, options, run->run_number); });
  std::ranges::reverse(*rows);  // the newest first
  const auto all = static_cast<std::int64_t>(rows->size()), shown = std::min(all, options.last.value_or(all));
  rows->resize(static_cast<std::size_t>(shown));
  const NotListed rest{.older = static_cast<std::size_t>(all - shown), .of_other_runs = others};
  const std::string text =
      options.json ? codec::to_json(*rows) + '\n' : reports_text(*rows, rest, run->now, colour);
  return {exit, text, ""};
}

Outcome show(const Adit& adit, const Options& options, bool colour) {
  const auto json = get(adit, "/adit/reports/" + std::to_string(options.numbers.front()));
  if (!json) return unable(json.error());
  const auto detail = read<api::ReportDetail>(adit, *json);
  if (!detail) return unable(detail.error());
  const Exit exit = exit_for({detail->row});
  return {exit, options.json ? *json + '\n' : report_text(*detail, colour), ""};
}

Outcome exported(const Adit& adit, const Options& options) {
  const auto text = get(adit, options.json ? "/adit/reports" : "/adit/reports.csv");
  if (!text) return unable(text.error());
  return {Exit::Fine, options.json ? *text + '\n' : *text, ""};
}

}  // namespace

Outcome reports(const Options& options, const Console& console) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  switch (options.verb) {
    case Verb::List:
      return list_reports(*adit, options, console.colour);
    case Verb::Show:
      return show(*adit, options, console.colour);
    case Verb::Export:
      return exported(*adit, options);
    default:
      return judge(*adit, options, console);
  }
}

}  // namespace adit::cli
