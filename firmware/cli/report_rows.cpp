#include "cli/report_rows.hpp"

#include "cli/reading.hpp"
#include "dispatch/report_life.hpp"

namespace adit::cli {
namespace {

using codec::Field;
using dispatch::ReportState;

/// A state that this adit does not know is one that only the operator can judge.
ReportState state_of(const api::ReportRow& report) {
  return dispatch::state_named(report.state).value_or(ReportState::InDoubt);
}

api::ReportStep step(const Field& row) {
  return {.at = number(row, "at"), .state = text(row, "state"), .note = text(row, "note")};
}

}  // namespace

api::ReportRow read_report(const Field& row) {
  const Field position = row.member("position");
  const Field score = row.member("score_change");
  api::ReportRow read;
  read.number = whole<std::int64_t>(row, "number");
  read.type = text(row, "type");
  read.lost = position.is_absent();
  if (!read.lost) read.position = {number(position, "x"), number(position, "y"), number(position, "z")};
  read.sender = text(row, "sender");
  read.received = number(row, "received");
  read.changed = number(row, "changed");
  read.state = text(row, "state");
  read.status = whole<int>(row, "status");
  read.report_status = text(row, "report_status");
  if (!score.is_absent()) read.score_change = score.whole<std::int64_t>();
  read.note = text(row, "note");
  read.run = whole<std::int64_t>(row, "run");
  read.asking = row.member("asking").truth();
  read.reconciled = row.member("reconciled").truth();
  read.same_as = whole<std::int64_t>(row, "same_as");
  return read;
}

std::expected<std::vector<api::ReportRow>, std::string> read_reports(std::string_view json) {
  return read<std::vector<api::ReportRow>>(json, [](const Field& array) { return rows(array, read_report); });
}

std::expected<api::ReportDetail, std::string> read_report_detail(std::string_view json) {
  return read<api::ReportDetail>(json, [](const Field& object) {
    return api::ReportDetail{.row = read_report(object),
                             .history = rows(object.member("history"), step),
                             .answer = text(object, "answer")};
  });
}

bool needs_the_operator(const api::ReportRow& report) {
  const ReportState state = state_of(report);
  return state == ReportState::Received || (state == ReportState::InDoubt && !report.asking);
}

bool is_finished(const api::ReportRow& report) {
  return dispatch::is_final(state_of(report));
}

}  // namespace adit::cli
