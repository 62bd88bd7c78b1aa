#include "rehearsal/command_post/scoring.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/fields.hpp"
#include "rehearsal/command_post/gate.hpp"

namespace adit::rehearsal {
namespace {

/// ISO 8601, combined date and time, in UTC.
std::string date_and_time() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  const auto micros = std::chrono::duration_cast<std::chrono::microseconds>(since).count();
  const std::time_t seconds = micros / 1'000'000;
  std::tm parts{};
  char text[64];
  if (gmtime_r(&seconds, &parts) == nullptr) return "";
  const std::size_t date = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  const int rest =
      std::snprintf(text + date, sizeof text - date, ".%06d+00:00", static_cast<int>(micros % 1'000'000));
  return {text, date + static_cast<std::size_t>(rest)};
}

struct Sent {
  std::string type;
  Point position;
};

std::optional<Sent> read_report(const Json& document, Findings& findings) {
  const Field body(document, "", findings);
  const auto position = read_point(body);
  const auto type = body.member("type");
  const auto text = type ? type->text() : std::nullopt;
  if (text && !is_artifact_type(*text))
    type->breaks("expected an artifact type of the final event (ICD 5.2)");
  const auto name = body.optional_member("name");
  const auto robot = name ? name->text() : std::nullopt;
  if (robot && !is_robot_name(*robot)) name->breaks("expected a robot's name (ICD 2)", Measured::Takes);
  if (!position || !text) return std::nullopt;
  return Sent{*text, *position};
}

}  // namespace

OrderedJson status_body(const Run& run, Clock::time_point now) {
  const Run::Standing standing = run.standing(now);
  return {{"score", standing.score},
          {"run_clock", standing.clock},
          {"remaining_reports", standing.remaining_reports},
          {"current_team", lower(standing.team)}};
}

OrderedJson report_body(const Run::Ruling& ruling, const Json& sent, const std::string& authority) {
  const std::string path = std::string(kReportsUri) + "/" + std::to_string(ruling.id);
  return {{"url", "http://" + authority + path},
          {"id", ruling.id},
          {"x", sent["x"]},
          {"y", sent["y"]},
          {"z", sent["z"]},
          {"type", sent["type"]},
          {"submitted_datetime", date_and_time()},
          {"run_clock", ruling.clock},
          {"team", lower(ruling.team)},
          {"run", ruling.run},
          {"report_status", ruling.status},
          {"score_change", ruling.score_change}};
}

void tell_repeat(const Run::Ruling& ruling, Findings& findings) {
  if (ruling.repeats == 0) return;
  findings.tells("the same report as report " + std::to_string(ruling.repeats) + " of this run");
}

StrictScoring::StrictScoring(std::string token, double hz, bool one_limit, Run& run)
    : token_(std::move(token)), run_(run), one_limit_(one_limit), status_limit_(hz), report_limit_(hz) {}

bool StrictScoring::too_many(const Request& request) {
  const std::lock_guard lock(mutex_);
  RateLimit& limit = request.path == kStatusUri && !one_limit_ ? status_limit_ : report_limit_;
  if (limit.too_soon(request, Clock::now())) return true;
  limit.count(request, request.at);
  return false;
}

Judgement StrictScoring::judge(const Request& request) {
  Judgement judgement;
  check_entry(request, kScoringFunctions, token_, judgement.findings);
  const Finding* const finding = judgement.findings.decisive(Manner::Strict);
  if (finding == nullptr || finding->status != 404) judgement.uri = request.path;
  if (finding != nullptr) {
    judgement.outcome = refused(*finding);
  } else if (too_many(request)) {
    judgement.outcome = refused(429, kTooManyRequests);
  } else if (judgement.uri == kStatusUri) {
    judgement.outcome = answered(200, status_body(run_, Clock::now()));
  } else {
    classify_report(request, judgement);
  }
  return judgement;
}

void StrictScoring::classify_report(const Request& request, Judgement& judgement) {
  Findings& findings = judgement.findings;
  check_content(request, false, findings);
  const auto document = read_document(request.body, Format::JsonText);
  std::optional<Sent> sent;
  if (document) {
    judgement.message = document->value;
    if (const auto& repeated = document->repeated) findings.breaks("'" + *repeated + "' is given twice");
    sent = read_report(document->value, findings);
  } else {
    findings.breaks("JSON parsing failed: " + document.error(), Measured::Refuses, 400);
  }
  if (const Finding* const finding = findings.decisive(Manner::Strict)) {
    judgement.outcome = refused(*finding);
  } else if (sent) {
    const Run::Ruling ruling = run_.submit(sent->type, sent->position, Clock::now());
    tell_repeat(ruling, findings);
    const auto& body = judgement.report.emplace(report_body(ruling, document->value, request.local_address));
    judgement.outcome = answered(201, body);
    judgement.accepted.push_back({"report", ""});
  } else {
    judgement.outcome = refused(422, "The report could not be read");
  }
}

}  // namespace adit::rehearsal
