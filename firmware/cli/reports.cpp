#include "cli/reports.hpp"

#include <algorithm>

#include "cli/ask.hpp"
#include "cli/deeds.hpp"
#include "cli/report_rows.hpp"
#include "cli/report_text.hpp"
#include "cli/reports_text.hpp"
#include "cli/run_view.hpp"
#include "cli/where.hpp"
#include "page/reports_json.hpp"

namespace adit::cli {
namespace {

std::string not_understood(const settings::Address& address, const std::string& why) {
  return "Adit at " + written(address) + " cannot be understood: " + why;
}

Exit exit_for(const std::vector<page::ReportRow>& reports) {
  return std::ranges::any_of(reports, needs_the_operator) ? Exit::Attention : Exit::Fine;
}

/// The present run's, and whatever is left of earlier ones: nothing that needs the operator is left out.
bool is_listed(const page::ReportRow& report, const Options& options, std::int64_t present) {
  if (options.all_runs) return true;
  return options.run ? report.run == *options.run : report.run == present || !is_finished(report);
}

Outcome list(const settings::Address& address, const Options& options, bool colour) {
  const auto run_json = get(address, "/adit/run");
  if (!run_json) return unable(run_json.error());
  const auto run = read_run_view(*run_json);
  if (!run) return unable(not_understood(address, run.error()));
  const auto json = get(address, "/adit/reports");
  if (!json) return unable(json.error());
  auto rows = read_reports(*json);
  if (!rows) return unable(not_understood(address, rows.error()));

  const Exit exit = exit_for(*rows);
  std::erase_if(*rows, [&](const page::ReportRow& row) { return !is_listed(row, options, run->run_number); });
  std::ranges::reverse(*rows);  // the newest first
  return {exit, options.json ? page::write_reports(*rows) + '\n' : reports_text(*rows, run->now, colour), ""};
}

Outcome show(const settings::Address& address, const Options& options, bool colour) {
  const auto json = get(address, "/adit/reports/" + std::to_string(options.numbers.front()));
  if (!json) return unable(json.error());
  const auto detail = read_report_detail(*json);
  if (!detail) return unable(not_understood(address, detail.error()));
  const Exit exit = exit_for({detail->row});
  return {exit, options.json ? *json + '\n' : report_text(*detail, colour), ""};
}

Outcome exported(const settings::Address& address, const Options& options) {
  const auto text = get(address, options.json ? "/adit/reports" : "/adit/reports.csv");
  if (!text) return unable(text.error());
  return {Exit::Fine, options.json ? *text + '\n' : *text, ""};
}

}  // namespace

Outcome reports(const Options& options, bool colour) {
  const auto address = address_of(options);
  if (!address) return unable(address.error());
  switch (options.verb) {
    case Verb::List:
      return list(*address, options, colour);
    case Verb::Show:
      return show(*address, options, colour);
    case Verb::Export:
      return exported(*address, options);
    default:
      return judge(*address, options);
  }
}

}  // namespace adit::cli
