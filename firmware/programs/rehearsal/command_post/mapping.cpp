#include "rehearsal/command_post/mapping.hpp"

#include "rehearsal/command_post/gate.hpp"

namespace adit::rehearsal {

bool StrictMapping::too_many(const std::string& uri, const Request& request) {
  const std::lock_guard lock(mutex_);
  RateLimit& limit = limits_.try_emplace(uri, hz_, counted_).first->second;
  const Clock::time_point now = Clock::now();
  if (limit.too_soon(request, now)) return true;
  limit.count(request, now);
  return false;
}

/// It has been judged: its answer follows.
void StrictMapping::count(const std::string& uri, const Request& request) {
  const std::lock_guard lock(mutex_);
  limits_.at(uri).count(request, Clock::now());
}

Judgement StrictMapping::judge(const Request& request) {
  Judgement judgement;
  check_entry(request, kMappingFunctions, token_, judgement.findings);
  const Finding* const finding = judgement.findings.decisive(Manner::Strict);
  if (finding == nullptr || finding->status != 404) judgement.uri = request.path;
  if (finding != nullptr) {
    judgement.outcome = refused(*finding);
  } else if (too_many(judgement.uri, request)) {
    judgement.outcome = refused(429, kTooManyRequests);
  } else {
    judge_body(request, judgement);
    count(judgement.uri, request);
  }
  return judgement;
}

void StrictMapping::judge_body(const Request& request, Judgement& judgement) {
  Findings& findings = judgement.findings;
  check_content(request, true, findings);
  std::optional<MappingMessage> message;
  if (findings.decisive(Manner::Strict) == nullptr) {
    const Format format = request.content_type == "application/cbor" ? Format::CborBytes : Format::JsonText;
    message = read_mapping(request.body, format, judgement);
  }
  if (message && findings.decisive(Manner::Strict) == nullptr) {
    stamps_.check(judgement.uri, message->stamps, false, findings);
  }
  if (const Finding* const finding = findings.decisive(Manner::Strict)) {
    judgement.outcome = refused(*finding);
  } else if (message) {
    judgement.outcome = answered(200, Json(nullptr));
    judgement.accepted = std::move(message->parts);
    judgement.markers = std::move(message->markers);
    judgement.map = std::move(message->map);
  } else {
    judgement.outcome = refused(422, kUnreadable);
  }
}

}  // namespace adit::rehearsal
