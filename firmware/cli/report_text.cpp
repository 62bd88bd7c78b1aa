#include "cli/report_text.hpp"

#include "api/reports_csv.hpp"
#include "cli/ask.hpp"
#include "cli/report_verbs.hpp"
#include "cli/reports_text.hpp"
#include "cli/table.hpp"
#include "dispatch/report_life.hpp"

namespace adit::cli {
namespace {

std::string actions_for(const api::ReportRow& report) {
  std::string text;
  for (const std::string_view verb : verbs_for(report)) text.append(text.empty() ? "" : ", ").append(verb);
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
  add("reason", report.note);
  add("answer", said_of(report));
  add("score", gained_by(report));
  add("run", std::to_string(report.run));
  add("sender", report.sender);
  add("robot", report.robot);
  add("received", api::iso_time(report.received));
  add("message", sentence_in(detail.answer));
  add("actions", actions_for(report));
  return table.written(colour);
}

std::string shown(const std::string& state) {
  const auto known = dispatch::state_named(state);
  return known ? std::string(dispatch::shown_name_of(*known)) : state;
}

std::string history(const api::ReportDetail& detail, bool colour) {
  Table table({{}, {}, {}});
  for (const api::ReportStep& step : detail.history) {
    table.add({{api::iso_time(step.at), Tone::Faint}, {shown(step.state), Tone::Strong}, {step.note}});
  }
  return table.empty() ? "" : "\nHistory\n" + table.written(colour);
}

}  // namespace

std::string report_text(const api::ReportDetail& detail, bool colour) {
  return facts(detail, colour) + history(detail, colour);
}

}  // namespace adit::cli
