#include <algorithm>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/scoring.hpp"

namespace adit::rehearsal {
namespace {

Outcome preflight() {
  Outcome outcome;
  outcome.answer.content_type = "text/html; charset=utf-8";
  outcome.answer.headers = {{"Access-Control-Allow-Headers",
                             "accept, accept-encoding, authorization, content-type, origin, user-agent"},
                            {"Access-Control-Allow-Methods", "DELETE, GET, OPTIONS, PATCH, POST, PUT"},
                            {"Access-Control-Max-Age", "86400"}};
  return outcome;
}

/// `Bearer` in any letter case.
bool shows(const std::optional<std::string>& authorization, const std::string& token) {
  constexpr std::string_view scheme = "bearer ";
  if (!authorization || authorization->size() != scheme.size() + token.size()) return false;
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(scheme.begin(), scheme.end(), authorization->begin(),
                    [&](char a, char b) { return a == lower(b); }) &&
         authorization->ends_with(token);
}

bool is_json(const std::optional<std::string>& content_type) {
  return content_type && content_type->substr(0, content_type->find(';')) == "application/json";
}

}  // namespace

MeasuredScoring::MeasuredScoring(std::string token, double hz, Run& run)
    : token_(std::move(token)), run_(run), limit_(hz) {}

bool MeasuredScoring::too_many(const Request& request) {
  const std::lock_guard lock(mutex_);
  if (limit_.too_soon(request, Clock::now())) return true;
  limit_.count(request, request.at);
  return false;
}

Judgement MeasuredScoring::judge(const Request& request) {
  Judgement judgement;
  if (request.method == "OPTIONS") {
    judgement.outcome = preflight();
  } else {
    check_entry(request, kScoringFunctions, token_, judgement.findings);
    const std::string_view path = without_slash(request.path);
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

void MeasuredScoring::judge_known(const Request& request, Judgement& judgement) {
  if (!shows(request.authorization, token_)) {
    judgement.outcome = detailed(
        401, request.authorization ? kInvalidToken : "Authentication credentials were not provided.");
    judgement.outcome.answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  } else if (too_many(request)) {
    judgement.outcome = detailed(429, kThrottled);
  } else if (request.method != (judgement.uri == kStatusUri ? "GET" : "POST")) {
    judgement.outcome = detailed(405, "Method \"" + request.method + "\" not allowed.");
  } else if (judgement.uri == kStatusUri) {
    OrderedJson body = status_body(run_, Clock::now());
    body["run_clock"] = kMeasuredStatusClock;
    judgement.outcome = answered(200, body);
  } else {
    classify_report(request, judgement);
  }
}

void MeasuredScoring::classify_report(const Request& request, Judgement& judgement) {
  check_content(request, false, judgement.findings);
  if (!is_json(request.content_type)) {
    judgement.outcome = detailed(415, "Unsupported media type in request.");
    return;
  }
  const auto document = read_document(request.body, Format::JsonText);
  if (!document) {
    judgement.findings.breaks("JSON parsing failed: " + document.error(), Measured::Refuses, 400);
    judgement.outcome = detailed(400, "JSON parse error - " + document.error());
    return;
  }
  const Json& sent = document->value;
  judgement.message = sent;
  for (const char* const name : {"x", "y", "z", "type"}) {
    if (sent.is_object() && sent.contains(name)) continue;
    const std::string sentence = std::string("Missing field: '") + name + "'";
    judgement.findings.breaks(sentence);
    judgement.outcome = refused(422, sentence);
    return;
  }
  if (!sent["type"].is_string()) {  // its handler crashes
    judgement.findings.breaks("type: expected a text string", Measured::Refuses, 500);
    judgement.outcome = page(500, "Server Error (500)");
    return;
  }
  // Types that do not exist and coordinates that are no numbers are recorded, and score nothing.
  const auto type = sent["type"].get<std::string>();
  std::optional<Point> position;
  if (sent["x"].is_number() && sent["y"].is_number() && sent["z"].is_number()) {
    position = Point{sent["x"].get<double>(), sent["y"].get<double>(), sent["z"].get<double>()};
  } else {
    judgement.findings.breaks("x, y, z: expected numbers", Measured::Takes);
  }
  if (!is_artifact_type(type)) {
    judgement.findings.breaks("type: expected an artifact type of the final event (ICD 5.2)",
                              Measured::Takes);
  }
  Run::Ruling ruling = run_.submit(type, position, Clock::now());
  ruling.clock = kMeasuredReportClock;
  tell_repeat(ruling, judgement.findings);
  judgement.report = report_body(ruling, sent, kNoAuthority);
  judgement.outcome = answered(201, *judgement.report);
  judgement.accepted.push_back({"report", ""});
}

}  // namespace adit::rehearsal
