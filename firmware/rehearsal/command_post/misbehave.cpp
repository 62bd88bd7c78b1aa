#include "rehearsal/command_post/misbehave.hpp"

#include <algorithm>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/gate.hpp"

namespace adit::rehearsal {
namespace {

using Deed = Fault::Deed;

/// Neither a status line nor the start of one.
constexpr std::string_view kGarbage("\x16\x03\x01\x00\x05this is no HTTP\r\n\r\n\0\xff", 26);

Outcome failure() {
  return page(500, "Server Error (500)");
}

/// 401 and 429, as the endpoint itself says them.
Outcome refusal(int status, Aim aim, Manner manner) {
  const bool unauthorized = status == 401;
  if (manner == Manner::Strict) return refused(status, unauthorized ? kWrongToken : kTooManyRequests);
  if (aim == Aim::Mapping) {
    Outcome outcome = refused(status, unauthorized ? kWrongToken : kTooManyClouds);
    outcome.after = After::CloseThoughPromisingNot;
    return outcome;
  }
  Outcome outcome = detailed(status, unauthorized ? kInvalidToken : kThrottled);
  if (unauthorized) outcome.answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  return outcome;
}

/// These bytes and no more; then the connection ends.
Outcome broken(std::string bytes, After after = After::Close) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::Breaks;
  outcome.bytes = std::move(bytes);
  outcome.after = after;
  return outcome;
}

Outcome spoiled(Deed deed, const Request& request, Outcome decided) {
  switch (deed) {
    case Deed::Drop:
    case Deed::RecordThenDrop:
      return broken("");
    case Deed::Reset:
    case Deed::ResetUnrecorded:
      return broken("", After::Reset);
    case Deed::Garbage:
      return broken(std::string(kGarbage));
    case Deed::RecordThenFail:
      return failure();
    case Deed::HalfAnswer: {
      std::string bytes = bytes_of(decided, request.method == "HEAD");
      bytes.resize(bytes.size() / 2);
      return broken(std::move(bytes));
    }
    case Deed::Behave:
    case Deed::Unauthorized:
    case Deed::TooMany:
    case Deed::Fail:
      break;
  }
  return decided;
}

void misstate_remaining(std::int64_t offset, Answer& answer) {
  OrderedJson body = OrderedJson::parse(answer.body, nullptr, false);
  const auto remaining = body.is_object() ? body.find("remaining_reports") : body.end();
  if (remaining == body.end()) return;
  *remaining = remaining->get<std::int64_t>() + offset;
  answer.body = line_of(body);
}

}  // namespace

std::optional<Aim> scoring_aim(const Request& request, Manner manner) {
  std::string_view path = path_of(request.target);
  if (manner == Manner::AsMeasured) path = without_slash(path);
  if (request.fault) return std::nullopt;
  if (request.method == "POST" && path == kReportsUri) return Aim::Reports;
  if (request.method == "GET" && path == kStatusUri) return Aim::Status;
  return std::nullopt;
}

std::optional<Aim> mapping_aim(const Request& request) {
  const std::string_view path = path_of(request.target);
  const bool known = std::ranges::any_of(kMappingFunctions, [&](const Function& function) {
    return function.method == request.method && function.uri == path;
  });
  if (request.fault || !known) return std::nullopt;
  return Aim::Mapping;
}

Judgement unjudged(const Fault& fault, Aim aim, const Request& request, Manner manner) {
  Judgement judgement;
  judgement.uri = aim == Aim::Mapping ? path_of(request.target) : without_slash(path_of(request.target));
  if (aim == Aim::Reports) {  // so that the transcript shows which report came to nothing
    if (auto document = read_document(request.body, Format::JsonText)) judgement.message = document->value;
  }
  if (fault.deed == Deed::Unauthorized) judgement.outcome = refusal(401, aim, manner);
  if (fault.deed == Deed::TooMany) judgement.outcome = refusal(429, aim, manner);
  if (fault.deed == Deed::Fail) judgement.outcome = failure();
  return judgement;
}

void spoil(const Fault& fault, const Request& request, Judgement& judgement) {
  Outcome& outcome = judgement.outcome;
  if (outcome.kind != Outcome::Kind::Answered || outcome.answer.status == 0) return;
  if (fault.remaining && judgement.uri == kStatusUri) misstate_remaining(*fault.remaining, outcome.answer);
  outcome = spoiled(fault.deed, request, std::move(outcome));
  if (fault.retry_after) {
    outcome.answer.headers.emplace_back("Retry-After", std::to_string(*fault.retry_after));
  }
}

Outcome later(Fault::Seconds delay, std::function<Outcome()> then) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::Later;
  outcome.delay = std::chrono::duration_cast<std::chrono::milliseconds>(delay);
  outcome.then = std::move(then);
  return outcome;
}

}  // namespace adit::rehearsal
