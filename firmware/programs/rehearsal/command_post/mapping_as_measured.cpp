#include <algorithm>

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/inflate.hpp"
#include "rehearsal/command_post/mapping.hpp"

namespace adit::rehearsal {
namespace {

/// After a 4xx it promises keep-alive and closes.
Outcome closing(Outcome outcome) {
  if (outcome.answer.status >= 400 && outcome.answer.status < 500)
    outcome.after = After::CloseThoughPromisingNot;
  return outcome;
}

/// An unknown URI or a method other than POST: 501 without a body.
Outcome not_implemented() {
  Outcome outcome;
  outcome.answer.status = 501;
  outcome.answer.content_type = "";
  return outcome;
}

/// It takes bodies that are compressed as a whole.
std::expected<std::string, InflateFault> whole_body(const Request& request) {
  constexpr std::size_t most = std::size_t{512} << 20;
  if (request.content_encoding == "gzip") return gunzip(request.body, most);
  if (request.content_encoding == "deflate") return inflate_body(request.body, most);
  return request.body;
}

Outcome outcome_of(const Finding& finding) {
  Outcome outcome = closing(refused(finding));
  if (finding.measured == Measured::Dies) outcome.kind = Outcome::Kind::Dies;
  if (finding.measured == Measured::Hangs) outcome.kind = Outcome::Kind::Hangs;
  return outcome;
}

}  // namespace

/// Of a cloud that has been decoded.
bool MeasuredMapping::cloud_too_soon(const Request& request) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  const bool soon = cloud_limit_.too_soon(request, now);
  cloud_limit_.count(request, now);
  return soon;
}

Judgement MeasuredMapping::judge(const Request& request) {
  Judgement judgement;
  check_entry(request, kMappingFunctions, token_, judgement.findings);
  const auto& found = judgement.findings.all();
  const bool known = found.empty() || found.front().status != 404;
  if (known) judgement.uri = request.path;
  if (!known) {
    judgement.outcome = not_implemented();
  } else if (!found.empty()) {  // its match of the whole Authorization header is exact, as ours is
    judgement.outcome = closing(refused(found.front()));
  } else {
    judge_body(request, judgement);
  }
  return judgement;
}

void MeasuredMapping::judge_body(const Request& request, Judgement& judgement) {
  Findings& findings = judgement.findings;
  check_content(request, true, findings);
  if (request.content_type != "application/json" && request.content_type != "application/cbor") {
    judgement.outcome = closing(refused(422, "Unknown Content-Type"));
    return;
  }
  const auto body = whole_body(request);
  if (!body) {
    judgement.outcome = closing(refused(400, "The body is not what Content-Encoding says"));
    return;
  }
  const Format format = request.content_type == "application/cbor" ? Format::CborBytes : Format::JsonText;
  auto message = read_mapping(*body, format, judgement);
  if (const Finding* const finding = findings.decisive(Manner::AsMeasured)) {
    judgement.outcome = outcome_of(*finding);
    return;
  }
  if (!message) {
    judgement.outcome = closing(refused(422, kUnreadable));
    return;
  }
  stamps_.check(judgement.uri, message->stamps, true, findings);
  judgement.outcome = answered(200, Json(nullptr));
  // Too many clouds are told off and taken all the same.
  if (message->map && std::holds_alternative<Cloud>(message->map->msg) && cloud_too_soon(request)) {
    judgement.outcome = closing(refused(429, kTooManyClouds));
  }
  judgement.accepted = std::move(message->parts);
  judgement.markers = std::move(message->markers);
  judgement.map = std::move(message->map);
}

}  // namespace adit::rehearsal
