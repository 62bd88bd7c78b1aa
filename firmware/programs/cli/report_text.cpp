#include "api/reports_csv.hpp"
#include "cli/ask.hpp"
#include "cli/reports_text.hpp"
#include "cli/table.hpp"
#include "dispatch/report_life.hpp"
#include "icd/text.hpp"

namespace adit::cli {
namespace {

std::string place_of(const icd::Point& point) {
  return decimal(point.x, 3) + ", " + decimal(point.y, 3) + ", " + decimal(point.z, 3) + " m";
}

std::string facts_of(const api::ReportDetail& detail, bool colour) {
  const api::ReportRow& report = detail.row;
  Facts facts;
  facts.add("report", std::to_string(report.number), Tone::Strong);
  facts.add("type", report.type, Tone::Strong);
  facts.add("at", report.position ? place_of(*report.position) : "lost");
  facts.add("state", life_of(report), tone_of(report));
  facts.add("reason", report.note);
  facts.add("answer", said_of(report));
  facts.add("score", gained_by(report));
  facts.add("run", std::to_string(report.run));
  facts.add("sender", report.sender);
  facts.add("robot", report.robot);
  facts.add("received", api::iso_time(report.received));
  facts.add("message", sentence_in(detail.answer));
  facts.add("actions", icd::listed(verbs_for(report)));
  return facts.written(colour);
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
  return facts_of(detail, colour) + history(detail, colour);
}

}  // namespace adit::cli
