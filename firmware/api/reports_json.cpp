#include "api/reports_json.hpp"

#include "api/as_json.hpp"
#include "codec/json.hpp"

namespace adit::api {

using codec::Value;

Value json(const ReportStep& step) {
  return {Value::Object{{"at", json(step.at)}, {"state", json(step.state)}, {"note", json(step.note)}}};
}

Value json(const ReportRow& row) {
  return {Value::Object{{"number", json(row.number)},
                        {"type", json(row.type)},
                        {"position", row.lost ? Value{} : json(row.position)},
                        {"sender", json(row.sender)},
                        {"received", json(row.received)},
                        {"changed", json(row.changed)},
                        {"state", json(row.state)},
                        {"status", json(row.status)},
                        {"report_status", json(row.report_status)},
                        {"score_change", json(row.score_change)},
                        {"note", json(row.note)},
                        {"run", json(row.run)},
                        {"asking", json(row.asking)},
                        {"reconciled", json(row.reconciled)},
                        {"same_as", json(row.same_as)}}};
}

std::string write_reports(const std::vector<ReportRow>& reports) {
  return codec::write_json(json(reports));
}

std::string write_report(const ReportDetail& report) {
  Value value = json(report.row);
  auto& members = std::get<Value::Object>(value.is);
  members.emplace_back("history", json(report.history));
  members.emplace_back("answer", json(report.answer));
  return codec::write_json(value);
}

}  // namespace adit::api
