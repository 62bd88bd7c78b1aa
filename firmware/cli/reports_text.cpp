#include "cli/reports_text.hpp"

#include <algorithm>

#include "cli/table.hpp"
#include "cli/words.hpp"
#include "dispatch/report_life.hpp"

namespace adit::cli {
namespace {

using dispatch::ReportState;
using Align = Table::Align;

Tone tone_of(const std::string& state) {
  switch (dispatch::state_named(state).value_or(ReportState::Waiting)) {
    case ReportState::InDoubt:
    case ReportState::Refused:
      return Tone::Bad;
    case ReportState::Answered:
      return Tone::Good;
    case ReportState::Waiting:
    case ReportState::Sending:
      break;
  }
  return Tone::Warning;
}

std::string gained(const page::ReportRow& report) {
  if (!report.score_change) return "";
  std::string text = *report.score_change > 0 ? "+" : "";
  return text.append(std::to_string(*report.score_change));
}

std::string said(const page::ReportRow& report) {
  std::string text;
  const auto add = [&text](const std::string& part) {
    if (!part.empty()) text.append(text.empty() ? "" : ", ").append(part);
  };
  add(report.status == 0 ? "" : std::to_string(report.status));
  add(report.report_status);
  add(report.note);
  return text;
}

}  // namespace

std::string reports_text(const page::RunView& view, bool colour) {
  if (view.reports.empty()) return "No reports so far.\n";
  Table table({{"no.", Align::Right},
               {"type"},
               {"x", Align::Right},
               {"y", Align::Right},
               {"z", Align::Right},
               {"state"},
               {"score", Align::Right},
               {"the Command Post said"},
               {"sender"},
               {"received", Align::Right}});
  for (const page::ReportRow& report : view.reports) {
    table.add({{std::to_string(report.number)},
               {report.type, Tone::Strong},
               {decimal(report.position.x, 2)},
               {decimal(report.position.y, 2)},
               {decimal(report.position.z, 2)},
               {report.state, tone_of(report.state)},
               {gained(report)},
               {said(report)},
               {report.sender},
               {duration(view.now - report.received) + " ago"}});
  }
  return table.written(colour);
}

bool any_in_doubt(const page::RunView& view) {
  return std::ranges::any_of(view.reports, [](const page::ReportRow& report) {
    return dispatch::state_named(report.state) == ReportState::InDoubt;
  });
}

}  // namespace adit::cli
