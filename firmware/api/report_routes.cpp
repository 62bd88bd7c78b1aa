#include "api/report_routes.hpp"

#include <optional>
#include <utility>

#include "api/answers.hpp"
#include "api/number_in.hpp"
#include "api/reports_csv.hpp"
#include "api/reports_json.hpp"
#include "api/small_body.hpp"
#include "codec/body_decoder.hpp"
#include "codec/field.hpp"
#include "codec/read.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

constexpr std::string_view kReports = "/adit/reports", kCsv = "/adit/reports.csv", kOne = "/adit/reports/",
                           kRuns = "/adit/runs";
constexpr std::string_view kAll = "all", kPresent = "present";
constexpr std::size_t kMostBody = 65536;
constexpr auto kAccepted = static_cast<icd::Status>(202);  // RFC 9110 15.3.3; no ICD answer has it

struct ActionName {
  std::string_view name;
  Action action;
};
constexpr ActionName kActions[] = {{"send", Action::Send},
                                   {"hold", Action::Hold},
                                   {"withdraw", Action::Withdraw},
                                   {"done", Action::CallDone},
                                   {"resubmit", Action::Resubmit}};

std::optional<Action> action_named(std::string_view name) {
  for (const ActionName& each : kActions) {
    if (each.name == name) return each.action;
  }
  return std::nullopt;
}

enum class Wanted : std::uint8_t { Judgement, Report, Run };

/// The path of an action: "/adit/reports/7/send", kReports or kRuns.
struct ActionPath {
  Wanted wanted = Wanted::Judgement;
  std::int64_t number = 0;  // of what is judged
  Action action = Action::Send;
};

std::optional<ActionPath> action_at(std::string_view path) {
  if (path == kRuns) return ActionPath{.wanted = Wanted::Run};
  if (path == kReports) return ActionPath{.wanted = Wanted::Report};
  const auto slash = path.rfind('/');
  if (!path.starts_with(kOne) || slash < kOne.size()) return std::nullopt;
  const auto number = number_in<std::int64_t>(path.substr(kOne.size(), slash - kOne.size()));
  const auto action = action_named(path.substr(slash + 1));
  if (!number || !action) return std::nullopt;
  return ActionPath{.number = *number, .action = *action};
}

intake::Answer no_such(std::int64_t number) {
  return refusal(icd::Status::NotFound, icd::sentence("there is no report ", number));
}

}  // namespace

ReportRoutes::ReportRoutes(const Source& source, Operator& judge, std::function<void()> changed)
    : source_(source), operator_(judge), changed_(std::move(changed)) {}

bool ReportRoutes::has(std::string_view path) {
  return path == kReports || path == kCsv || path == kRuns || path.starts_with(kOne);
}

std::unique_ptr<intake::BodySink> ReportRoutes::open(const intake::RequestHead& head,
                                                     std::shared_ptr<intake::Responder> responder) {
  const auto refuse = [&responder](intake::Answer answer) {
    responder->answer(std::move(answer));
    return nullptr;
  };
  const bool lists = head.path() == kReports && only_reads(head);
  const auto path = lists ? std::nullopt : action_at(head.path());
  if (!path) return refuse(only_reads(head) ? shown(head) : wrong_method(kReading));
  if (head.method() != "POST") {
    return refuse(wrong_method(path->wanted == Wanted::Report ? "GET, HEAD, POST" : "POST"));
  }
  if (codec::format_of(head.header("Content-Type")) != codec::Format::Json) {
    return refuse(refusal(icd::Status::UnprocessableEntity, "Content-Type: expected application/json"));
  }
  if (head.content_length().value_or(0) > kMostBody) return refuse(SmallBody::too_long(kMostBody));
  return std::make_unique<SmallBody>(
      responder, kMostBody, [this, path = *path, responder](const std::string& body) {
        auto answer = path.wanted == Wanted::Judgement ? judge(path.number, path.action)
                      : path.wanted == Wanted::Report  ? report(body)
                                                       : begin_run();
        changed_();
        responder->answer(std::move(answer));
      });
}

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

intake::Answer ReportRoutes::shown(const intake::RequestHead& head) const {
  const std::string_view path = head.path();
  if (path == kReports || path == kCsv) {
    const auto rows = listed(head.query("run"));
    if (!rows) return refusal(rows.error().status, rows.error().sentence);
    if (path == kReports) return fresh("application/json", write_reports(*rows));
    auto answer = fresh("text/csv; charset=utf-8; header=present", write_reports_csv(*rows));
    answer.headers.push_back({"Content-Disposition", "attachment; filename=\"adit-reports.csv\""});
    return answer;
  }
  const auto number = number_in<std::int64_t>(path.substr(kOne.size()));
  if (!number) return nothing_here();
  const auto report = source_.report(*number);
  return report ? fresh("application/json", write_report(*report)) : no_such(*number);
}

intake::Answer ReportRoutes::judge(std::int64_t number, Action action) {
  if (!source_.report(number)) return no_such(number);
  const auto moved = operator_.judge(number, action);
  if (!moved) return refusal(icd::Status::Conflict, moved.error());
  return fresh("application/json", "{\"report\":" + std::to_string(*moved) + "}");
}

intake::Answer ReportRoutes::report(std::string_view body) {
  const auto document = codec::decode({}, codec::Split::Nothing, body);
  if (!document) return refusal(document.error().status, document.error().sentence);
  const auto report = codec::read_artifact_report(*document, {});
  if (!report) return refusal(report.error().status, report.error().sentence);
  codec::Reading reading;
  const codec::Field root(document->root, reading);
  const codec::Field resubmit = root.member("resubmit");
  const auto again = reading.outcome(!resubmit.is_absent() && resubmit.truth());
  if (!again) return refusal(again.error().status, again.error().sentence);
  const auto number = operator_.report(*report, *again);
  if (!number) return refusal(icd::Status::Conflict, number.error());
  auto answer = fresh("application/json", "{\"report\":" + std::to_string(*number) + "}");
  answer.status = kAccepted;
  return answer;
}

intake::Answer ReportRoutes::begin_run() {
  return fresh("application/json", "{\"run\":" + std::to_string(operator_.begin_run()) + "}");
}

}  // namespace adit::api
