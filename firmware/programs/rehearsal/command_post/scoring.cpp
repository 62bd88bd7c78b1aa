#include <chrono>

#include "icd/sentence.hpp"
#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/command_post/server.hpp"

namespace adit::rehearsal {
namespace {

/// ISO 8601, combined date and time, in UTC, with microseconds.
std::string date_and_time() {
  const auto now = std::chrono::system_clock::now();
  const auto whole = std::chrono::floor<std::chrono::seconds>(now);
  const auto micros = std::chrono::floor<std::chrono::microseconds>(now - whole).count();
  return utc_text("%Y-%m-%dT%H:%M:%S.", whole) + std::to_string(1'000'000 + micros).substr(1) + "+00:00";
}

std::optional<Artifact> read_report(const Json& document, Findings& findings) {
  const Field body(document, "", findings);
  const auto position = read_point(body);
  const auto type = body.member("type");
  const auto text = type.and_then(&Field::to_text);
  if (text && !is_artifact_type(*text))
    type->add_violation("expected an artifact type of the final event (ICD 5.2)");
  const auto name = body.optional_member("name");
  const auto robot = name.and_then(&Field::to_text);
  if (robot && !is_robot_name(*robot))
    name->add_violation("expected a robot's name (ICD 2)", Measured::Takes);
  if (!position || !text) return std::nullopt;
  return Artifact{*text, *position};
}

/// The body of GET /api/status (ICD 5.1).
OrderedJson status_body(const Run& run, Clock::time_point now) {
  const Run::Standing standing = run.standing(now);
  return {{"score", standing.score},
          {"run_clock", standing.clock},
          {"remaining_reports", standing.remaining_reports},
          {"current_team", lower(standing.team)}};
}

/// The answer to a report that the run has ruled on.
void answer_report(const Run::Ruling& ruling, const Json& sent, const std::string& authority,
                   Judgement& judgement) {
  if (ruling.repeats != 0)
    judgement.findings.add_remark(
        icd::sentence("the same report as report ", ruling.repeats, " of this run"));
  judgement.report = report_body(ruling, sent, authority);
  judgement.outcome = answer_with(201, *judgement.report);
  judgement.accepted.parts.push_back({"report", ""});
}

class StrictScoring : public Endpoint {
 public:
  StrictScoring(std::string token, double hz, bool one_limit, Run& run)
      : token_(std::move(token)), run_(run), one_limit_(one_limit), status_limit_(hz), report_limit_(hz) {}

  Judgement judge(const Request& request) override {
    Judgement judgement;
    const bool is_status = request.path == kStatusUri;
    RateLimit* const limit = is_status && !one_limit_ ? &status_limit_ : &report_limit_;
    if (!admit(request, kScoringFunctions, token_, limit, judgement)) return judgement;
    if (is_status) {
      judgement.outcome = answer_with(200, status_body(run_, Clock::now()));
    } else {
      classify_report(request, judgement);
    }
    return judgement;
  }

 private:
  void classify_report(const Request& request, Judgement& judgement) {
    Findings& findings = judgement.findings;
    check_content(request, false, findings);
    const auto document = read_document(request.body, Format::JsonText);
    std::optional<Artifact> sent;
    if (document) {
      judgement.message = document->value;
      if (const auto& repeated = document->repeated)
        findings.add_violation("'" + *repeated + "' is given twice");
      sent = read_report(document->value, findings);
    } else {
      findings.add_violation("JSON parsing failed: " + document.error(), Measured::Refuses, 400);
    }
    if (const Finding* const finding = findings.first_rejected(Manner::Strict)) {
      judgement.outcome = answer_refusal(*finding);
    } else if (sent) {
      answer_report(run_.submit(sent->type, sent->position, Clock::now()), document->value,
                    request.local_address, judgement);
    } else {
      judgement.outcome = answer_refusal(422, "The report could not be read");
    }
  }

  const std::string token_;
  Run& run_;
  const bool one_limit_;
  RateLimit status_limit_;
  RateLimit report_limit_;  // of statuses too, if there is one limit
};

Outcome preflight() {
  return {.answer = {.content_type = "text/html; charset=utf-8",
                     .headers = {{"Access-Control-Allow-Headers",
                                  "accept, accept-encoding, authorization, content-type, origin, user-agent"},
                                 {"Access-Control-Allow-Methods", "DELETE, GET, OPTIONS, PATCH, POST, PUT"},
                                 {"Access-Control-Max-Age", "86400"}}}};
}

/// `Bearer` in any letter case.
bool is_authorized(const std::optional<std::string>& authorization, const std::string& token) {
  constexpr std::string_view scheme = "bearer ";
  if (!authorization || authorization->size() != scheme.size() + token.size()) return false;
  return lower(authorization->substr(0, scheme.size())) == scheme && authorization->ends_with(token);
}

bool is_json(const std::optional<std::string>& content_type) {
  return content_type && content_type->substr(0, content_type->find(';')) == "application/json";
}

class MeasuredScoring : public Endpoint {
 public:
  MeasuredScoring(std::string token, double hz, Run& run) : token_(std::move(token)), run_(run), limit_(hz) {}

  Judgement judge(const Request& request) override {
    Judgement judgement;
    if (request.method == "OPTIONS") {
      judgement.outcome = preflight();
    } else {
      check_entry(request, kScoringFunctions, token_, judgement.findings);
      const std::string_view path = strip_slash(request.path);
      if (path == kStatusUri || path == kReportsUri) {
        judgement.uri = path;
        judge_known(request, judgement);
      } else {
        judgement.outcome = page(404, "Not Found");
      }
    }
    if (request.origin) judgement.outcome.answer.headers.emplace_back("Access-Control-Allow-Origin", "*");
    return judgement;
  }

 private:
  void judge_known(const Request& request, Judgement& judgement) {
    if (!is_authorized(request.authorization, token_)) {
      judgement.outcome = answer_with_detail(
          401, request.authorization ? kInvalidToken : "Authentication credentials were not provided.");
      judgement.outcome.answer.headers.emplace_back("WWW-Authenticate", "Bearer");
    } else if (limit_.is_too_soon(request)) {
      judgement.outcome = answer_with_detail(429, kThrottled);
    } else if (request.method != (judgement.uri == kStatusUri ? "GET" : "POST")) {
      judgement.outcome = answer_with_detail(405, "Method \"" + request.method + "\" not allowed.");
    } else if (judgement.uri == kStatusUri) {
      OrderedJson body = status_body(run_, Clock::now());
      body["run_clock"] = kMeasuredStatusClock;
      judgement.outcome = answer_with(200, body);
    } else {
      classify_report(request, judgement);
    }
  }

  void classify_report(const Request& request, Judgement& judgement) {
    check_content(request, false, judgement.findings);
    if (!is_json(request.content_type)) {
      judgement.outcome = answer_with_detail(415, "Unsupported media type in request.");
      return;
    }
    const auto document = read_document(request.body, Format::JsonText);
    if (!document) {
      judgement.findings.add_violation("JSON parsing failed: " + document.error(), Measured::Refuses, 400);
      judgement.outcome = answer_with_detail(400, "JSON parse error - " + document.error());
      return;
    }
    const Json& sent = document->value;
    judgement.message = sent;
    for (const char* const name : {"x", "y", "z", "type"}) {
      if (sent.is_object() && sent.contains(name)) continue;
      const std::string sentence = std::string("Missing field: '") + name + "'";
      judgement.findings.add_violation(sentence);
      judgement.outcome = answer_refusal(422, sentence);
      return;
    }
    if (!sent["type"].is_string()) {  // its handler crashes
      judgement.findings.add_violation("type: expected a text string", Measured::Refuses, 500);
      judgement.outcome = page(500, "Server Error (500)");
      return;
    }
    // Types that do not exist and coordinates that are no numbers are recorded, and score nothing.
    const auto type = sent["type"].get<std::string>();
    std::optional<Vector3> position;
    if (sent["x"].is_number() && sent["y"].is_number() && sent["z"].is_number()) {
      position = Vector3{sent["x"].get<double>(), sent["y"].get<double>(), sent["z"].get<double>()};
    } else {
      judgement.findings.add_violation("x, y, z: expected numbers", Measured::Takes);
    }
    if (!is_artifact_type(type)) {
      judgement.findings.add_violation("type: expected an artifact type of the final event (ICD 5.2)",
                                       Measured::Takes);
    }
    Run::Ruling ruling = run_.submit(type, position, Clock::now());
    ruling.clock = kMeasuredReportClock;
    answer_report(ruling, sent, kNoAuthority, judgement);
  }

  const std::string token_;
  Run& run_;
  RateLimit limit_;
};

}  // namespace

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

std::unique_ptr<Endpoint> scoring_endpoint(Manner manner, std::string token, std::optional<double> hz,
                                           bool one_limit, Run& run) {
  if (manner == Manner::Strict)
    return std::make_unique<StrictScoring>(std::move(token), hz.value_or(1), one_limit, run);
  return std::make_unique<MeasuredScoring>(std::move(token), hz.value_or(0), run);
}

}  // namespace adit::rehearsal
