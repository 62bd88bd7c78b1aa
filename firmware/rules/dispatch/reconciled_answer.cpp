#include "dispatch/reconciled_answer.hpp"

#include <cmath>
#include <cstdio>
#include <ctime>

#include "codec/json.hpp"

namespace adit::dispatch {
namespace {

using codec::Value;

/// ISO 8601 in UTC (ICD 5.2 submitted_datetime).
std::string date_and_time(double stamp) {
  const auto seconds = static_cast<std::time_t>(std::floor(stamp));
  std::tm parts{};
  char text[64];
  if (gmtime_r(&seconds, &parts) == nullptr) return "";
  const std::size_t date = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  const int rest = std::snprintf(text + date, sizeof text - date, ".%06d+00:00",
                                 static_cast<int>((stamp - std::floor(stamp)) * 1e6));
  return {text, date + static_cast<std::size_t>(rest)};
}

Value text_or_null(const std::string& text) {
  return text.empty() ? Value{} : Value{text};
}

}  // namespace

std::string reconciled_answer(const Report& report, const Run& run, std::optional<std::int64_t> points,
                              const std::string& figures) {
  const icd::Point& at = report.report.position;
  return codec::write_json({Value::Object{
      {"url", Value{}},
      {"id", Value{}},
      {"x", {at.x}},
      {"y", {at.y}},
      {"z", {at.z}},
      {"type", {report.report.type}},
      {"submitted_datetime", {date_and_time(report.sent)}},
      {"run_clock", report.before ? Value{std::round(report.before->run_clock * 1000) / 1000} : Value{}},
      {"team", text_or_null(run.last ? run.last->current_team : "")},
      {"run", text_or_null(run.id)},
      {"report_status", {std::string("scored")}},
      {"score_change", points ? Value{*points} : Value{}},
      {"adit",
       {Value::Object{{"reconciled", {true}}, {"report", {report.number}}, {"evidence", {figures}}}}}}});
}

}  // namespace adit::dispatch
