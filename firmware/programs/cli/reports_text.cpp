#include "cli/reports_text.hpp"

#include "cli/table.hpp"
#include "dispatch/report.hpp"
#include "icd/text.hpp"

namespace adit::cli {
namespace {

using dispatch::ReportState;
using Align = Table::Align;

std::string counted(std::size_t count, const char* one, const char* several) {
  return count == 0 ? "" : std::to_string(count) + (count == 1 ? one : several);
}

std::string not_listed(const OmittedReports& rest) {
  return counted(rest.older, " older report is not listed\n", " older reports are not listed\n") +
         counted(rest.of_other_runs, " report of another run is not listed: adit reports --run all\n",
                 " reports of other runs are not listed: adit reports --run all\n");
}

std::string coordinate(const api::ReportRow& report, double icd::Point::* axis) {
  return report.position ? decimal((*report.position).*axis, 2) : "lost";
}

/// A state unknown to this adit is shown as in doubt.
ReportState state_of(const api::ReportRow& report) {
  return dispatch::state_named(report.state).value_or(ReportState::InDoubt);
}

}  // namespace

bool needs_the_operator(const api::ReportRow& report) {
  const ReportState state = state_of(report);
  return (state == ReportState::Held && !report.sends_at) ||
         (state == ReportState::InDoubt && !report.asking);
}

bool is_finished(const api::ReportRow& report) {
  return dispatch::is_final(state_of(report));
}

std::vector<std::string_view> verbs_for(const api::ReportRow& report) {
  using dispatch::ReportEvent;
  const auto state = dispatch::state_named(report.state);
  if (!state) return {};
  std::vector<std::string_view> verbs;
  const auto offer = [&verbs](bool possible, std::string_view verb) {
    if (possible) verbs.push_back(verb);
  };
  offer(dispatch::transition(*state, ReportEvent::Released) != nullptr, "send");
  offer(dispatch::transition(*state, ReportEvent::HeldBack) != nullptr || report.sends_at, "hold");
  offer(dispatch::transition(*state, ReportEvent::Withdrawn) != nullptr, "withdraw");
  offer(dispatch::transition(*state, ReportEvent::Corrected) != nullptr, "correct");
  offer(dispatch::transition(*state, ReportEvent::Settled) != nullptr, "settle");
  offer(dispatch::is_final(*state), "resubmit");
  return verbs;
}

std::string life_of(const api::ReportRow& report) {
  const auto state = dispatch::state_named(report.state);
  if (!state) return report.state;
  std::string life(dispatch::shown_name_of(*state));
  if (report.sends_at) life += ", to be sent";
  return report.asking && *state == ReportState::InDoubt ? life + ", asking" : life;
}

Tone tone_of(const api::ReportRow& report) {
  if (needs_the_operator(report)) return Tone::Bad;
  switch (state_of(report)) {
    case ReportState::Rejected:
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

std::string said_of(const api::ReportRow& report) {
  const bool is_error = report.status >= 300 && !report.reconciled;
  return icd::listed(std::array{std::string(report.reconciled ? "found out" : ""),
                                is_error ? "error " + std::to_string(report.status) : "",
                                report.report_status});
}

std::string gained_by(const api::ReportRow& report) {
  if (!report.score_change) return "";
  std::string text = *report.score_change > 0 ? "+" : "";
  return text.append(std::to_string(*report.score_change));
}

std::string reports_text(const std::vector<api::ReportRow>& reports, const OmittedReports& rest,
                         api::Time now, bool colour) {
  if (reports.empty())
    return (rest.of_other_runs == 0 ? "No reports so far.\n" : "No reports in this run so far.\n") +
           not_listed(rest);
  Table table({{"no.", Align::Right},
               {"run", Align::Right},
               {"type"},
               {"x", Align::Right},
               {"y", Align::Right},
               {"z", Align::Right},
               {"state"},
               {"score", Align::Right},
               {"answer or reason"},
               {"sender"},
               {"robot"},
               {"received", Align::Right}});
  for (const api::ReportRow& report : reports) {
    table.add({{std::to_string(report.number)},
               {std::to_string(report.run)},
               {report.type, Tone::Strong},
               {coordinate(report, &icd::Point::x)},
               {coordinate(report, &icd::Point::y)},
               {coordinate(report, &icd::Point::z)},
               {life_of(report), tone_of(report)},
               {gained_by(report)},
               {icd::listed(std::array{said_of(report), report.note})},
               {report.sender},
               {report.robot},
               {duration(now - report.received) + " ago"}});
  }
  return table.written(colour) + not_listed(rest);
}

}  // namespace adit::cli
