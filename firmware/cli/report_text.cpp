#include "cli/report_text.hpp"

#include "api/reports_csv.hpp"
#include "cli/reports_text.hpp"
#include "cli/table.hpp"
#include "dispatch/report_life.hpp"

namespace adit::cli {
namespace {

using dispatch::ReportEvent;

/// The actions that the table of a report's life has for where it is.
std::string actions_for(const api::ReportRow& report) {
  const auto state = dispatch::state_named(report.state);
  if (!state) return "";
  std::string text;
  const auto offer = [&text](bool possible, const char* action) {
    if (possible) text.append(text.empty() ? "" : ", ").append(action);
  };
  offer(dispatch::transition(*state, ReportEvent::Released) != nullptr, "send");
  offer(dispatch::transition(*state, ReportEvent::HeldBack) != nullptr, "hold");
  offer(dispatch::transition(*state, ReportEvent::Withdrawn) != nullptr, "withdraw");
  offer(dispatch::transition(*state, ReportEvent::CalledDone) != nullptr, "done");
  offer(dispatch::is_final(*state), "resubmit");
  return text;
}

std::string place_of(const icd::Point& point) {
  return decimal(point.x, 3) + ", " + decimal(point.y, 3) + ", " + decimal(point.z, 3) + " m";
}

std::string facts(const api::ReportDetail& detail, bool colour) {
  const api::ReportRow& report = detail.row;
  Table table({{}, {}});
  const auto add = [&table](const char* name, const std::string& text, Tone tone = Tone::Plain) {
    if (!text.empty()) table.add({{name, Tone::Faint}, {text, tone}});
  };
  add("report", std::to_string(report.number), Tone::Strong);
  add("type", report.type, Tone::Strong);
  add("at", report.position ? place_of(*report.position) : "lost");
  add("state", life_of(report), tone_of(report));
  add("why", report.note);
  add("said", said_of(report));
  add("score", gained_by(report));
  add("run", std::to_string(report.run));
  add("sender", report.sender);
  add("received", api::iso_time(report.received));
  add("answer", detail.answer);
  add("actions", actions_for(report));
  return table.written(colour);
}

std::string history(const api::ReportDetail& detail, bool colour) {
  Table table({{}, {}, {}});
  for (const api::ReportStep& step : detail.history) {
    table.add({{api::iso_time(step.at), Tone::Faint}, {step.state, Tone::Strong}, {step.note}});
  }
  return table.empty() ? "" : "\nHistory\n" + table.written(colour);
}

}  // namespace

std::string report_text(const api::ReportDetail& detail, bool colour) {
  return facts(detail, colour) + history(detail, colour);
}

}  // namespace adit::cli
