#include "cli/reports_text.hpp"

#include "cli/report_rows.hpp"
#include "cli/table.hpp"
#include "dispatch/report_life.hpp"

namespace adit::cli {
namespace {

using dispatch::ReportState;
using Align = Table::Align;

std::string joined(std::initializer_list<std::string> parts) {
  std::string text;
  for (const std::string& part : parts) {
    if (!part.empty()) text.append(text.empty() ? "" : ", ").append(part);
  }
  return text;
}

}  // namespace

std::string life_of(const page::ReportRow& report) {
  switch (dispatch::state_named(report.state).value_or(ReportState::Waiting)) {
    case ReportState::Received:
      return "held";
    case ReportState::InDoubt:
      return report.asking ? "in doubt, asking" : "in doubt";
    case ReportState::Settled:
      return report.reconciled ? "settled" : "called done";
    case ReportState::Withdrawn:
      return report.same_as == 0 ? "withdrawn" : "same as " + std::to_string(report.same_as);
    default:
      return report.state;
  }
}

Tone tone_of(const page::ReportRow& report) {
  if (needs_the_operator(report)) return Tone::Bad;
  switch (dispatch::state_named(report.state).value_or(ReportState::InDoubt)) {
    case ReportState::Refused:
      return Tone::Bad;
    case ReportState::Answered:
      return Tone::Good;
    case ReportState::Settled:
      return report.reconciled ? Tone::Good : Tone::Plain;
    case ReportState::Withdrawn:
      return Tone::Plain;
    default:
      return Tone::Warning;
  }
}

std::string said_of(const page::ReportRow& report) {
  return joined({report.reconciled ? "found out" : "",
                 report.status == 0 || report.reconciled ? "" : std::to_string(report.status),
                 report.report_status});
}

std::string gained_by(const page::ReportRow& report) {
  if (!report.score_change) return "";
  std::string text = *report.score_change > 0 ? "+" : "";
  return text.append(std::to_string(*report.score_change));
}

std::string reports_text(const std::vector<page::ReportRow>& reports, page::Time now, bool colour) {
  if (reports.empty()) return "No reports so far.\n";
  Table table({{"no.", Align::Right},
               {"run", Align::Right},
               {"type"},
               {"x", Align::Right},
               {"y", Align::Right},
               {"z", Align::Right},
               {"state"},
               {"score", Align::Right},
               {"the Command Post said, or why"},
               {"sender"},
               {"received", Align::Right}});
  for (const page::ReportRow& report : reports) {
    table.add({{std::to_string(report.number)},
               {std::to_string(report.run)},
               {report.type, Tone::Strong},
               {decimal(report.position.x, 2)},
               {decimal(report.position.y, 2)},
               {decimal(report.position.z, 2)},
               {life_of(report), tone_of(report)},
               {gained_by(report)},
               {joined({said_of(report), report.note})},
               {report.sender},
               {duration(now - report.received) + " ago"}});
  }
  return table.written(colour);
}

}  // namespace adit::cli
