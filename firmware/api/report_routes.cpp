#include "api/report_routes.hpp"

#include <utility>

#include "api/answers.hpp"
#include "api/number_in.hpp"
#include "api/reports_csv.hpp"
#include "codec/body_decoder.hpp"
#include "codec/field.hpp"
#include "codec/read.hpp"
#include "codec/row.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
using codec::json;
namespace {

constexpr std::string_view kAll = "all", kPresent = "present";
constexpr auto kAccepted = static_cast<icd::Status>(202);  // RFC 9110 15.3.3; no ICD answer has it

intake::Answer no_such(std::int64_t number) {
  return refusal(icd::Status::NotFound, icd::sentence("there is no report ", number));
}

}  // namespace

ReportRoutes::ReportRoutes(const Source& source, Operator& judge, std::function<void()> changed)
    : source_(source), operator_(judge), changed_(std::move(changed)) {}

icd::Checked<std::vector<ReportRow>> ReportRoutes::listed(std::string_view run) const {
  std::vector<ReportRow> rows = source_.reports();
  if (run.empty() || run == kAll) return rows;
  const auto number = run == kPresent ? source_.view().run_number : number_in<std::int64_t>(run);
  if (!number) {
    return std::unexpected(
        icd::Refusal{icd::Status::BadRequest, "run: expected a run's number, present or all"});
  }
  std::erase_if(rows, [&](const ReportRow& row) { return row.run != *number; });
  return rows;
}

intake::Answer ReportRoutes::list(const intake::RequestHead& head) const {
  const auto rows = listed(head.query("run"));
  return rows ? fresh("application/json", codec::to_json(*rows)) : refused(rows.error());
}

intake::Answer ReportRoutes::csv(const intake::RequestHead& head) const {
  const auto rows = listed(head.query("run"));
  if (!rows) return refused(rows.error());
  auto answer = fresh("text/csv; charset=utf-8; header=present", write_reports_csv(*rows));
  answer.headers.push_back({"Content-Disposition", "attachment; filename=\"adit-reports.csv\""});
  return answer;
}

intake::Answer ReportRoutes::one(std::int64_t number) const {
  const auto report = source_.report(number);
  return report ? fresh("application/json", codec::to_json(*report)) : no_such(number);
}

intake::Answer ReportRoutes::judge(std::int64_t number, Action action) {
  const bool known = source_.report(number).has_value();
  const auto moved = known ? operator_.judge(number, action) : number;
  changed_();
  if (!known) return no_such(number);
  if (!moved) return refusal(icd::Status::Conflict, moved.error());
  return object({{"report", json(*moved)}});
}

intake::Answer ReportRoutes::compose(const std::string& body) {
  auto answer = composed(body);
  changed_();
  return answer;
}

intake::Answer ReportRoutes::composed(const std::string& body) {
  const auto document = codec::decode({}, codec::Split::Nothing, body);
  if (!document) return refused(document.error());
  const auto report = codec::read_artifact_report(*document, {});
  if (!report) return refused(report.error());
  codec::Reading reading;
  const codec::Field root(document->root, reading);
  const codec::Field resubmit = root.member("resubmit");
  const auto again = reading.outcome(!resubmit.is_absent() && resubmit.truth());
  if (!again) return refused(again.error());
  const auto number = operator_.report(*report, *again);
  if (!number) return refusal(icd::Status::Conflict, number.error());
  auto answer = object({{"report", json(*number)}});
  answer.status = kAccepted;
  return answer;
}

}  // namespace adit::api
