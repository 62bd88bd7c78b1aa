#include "rehearsal/command_post/misbehave.hpp"

#include <algorithm>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {
namespace {

using Deed = Fault::Deed;

/// Neither a status line nor the start of one.
constexpr std::string_view kGarbage("\x16\x03\x01\x00\x05this is no HTTP\r\n\r\n\0\xff", 26);

Outcome failure() {
  return page(500, "Server Error (500)");
}

/// As a captive portal says it, or a server that is none of the ICD's.
Outcome portal(int status) {
  Outcome outcome = page(status, "Log in to the network");
  outcome.after = After::Close;
  if (status == 302) outcome.answer.headers.emplace_back("Location", "http://192.0.2.1/login");
  return outcome;
}

std::string repeated(std::string_view text, std::size_t bytes) {
  std::string all;
  while (all.size() < bytes) all += text;
  return all;
}

/// The bytes of the deeds that would end a client which takes a peer at its word.
std::string overwhelming(Deed deed) {
  constexpr std::size_t kMuch = std::size_t{4} << 20;
  switch (deed) {
    case Deed::LengthHuge:
      return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: 30000000000\r\n\r\n{";
    case Deed::ChunkHuge:
      return "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n6fc23ac00\r\n{";
    case Deed::HeaderFlood:
      return "HTTP/1.1 200 OK\r\n" + repeated("X-Flood: 0123456789\r\n", kMuch);
    case Deed::EndlessBody:
      return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n\r\n[" + repeated("0,", kMuch);
    case Deed::InterimFlood:
      return repeated("HTTP/1.1 100 Continue\r\n\r\n", kMuch);
    case Deed::JsonDeep: {
      const std::string body(15'000, '[');
      return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nConnection: close\r\nContent-Length: " +
             std::to_string(body.size()) + "\r\n\r\n" + body;
    }
    default:
      return "";
  }
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
    case Deed::LengthHuge:
    case Deed::ChunkHuge:
    case Deed::HeaderFlood:
    case Deed::EndlessBody:
    case Deed::InterimFlood:
    case Deed::JsonDeep:
      return broken(overwhelming(deed));
    case Deed::Behave:
    case Deed::Unauthorized:
    case Deed::TooMany:
    case Deed::Fail:
    case Deed::PageOk:
    case Deed::PageElsewhere:
    case Deed::PageBad:
    case Deed::PageUnprocessable:
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

void stop_clock(double clock, Answer& answer) {
  OrderedJson body = OrderedJson::parse(answer.body, nullptr, false);
  const auto shown = body.is_object() ? body.find("run_clock") : body.end();
  if (shown == body.end()) return;
  *shown = clock;
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
  if (fault.deed == Deed::PageOk) judgement.outcome = portal(200);
  if (fault.deed == Deed::PageElsewhere) judgement.outcome = portal(302);
  if (fault.deed == Deed::PageBad) judgement.outcome = portal(400);
  if (fault.deed == Deed::PageUnprocessable) judgement.outcome = portal(422);
  return judgement;
}

void spoil(const Fault& fault, const Request& request, Judgement& judgement) {
  Outcome& outcome = judgement.outcome;
  if (outcome.kind != Outcome::Kind::Answered || outcome.answer.status == 0) return;
  if (fault.remaining && judgement.uri == kStatusUri) misstate_remaining(*fault.remaining, outcome.answer);
  if (fault.clock_stands) {
    stop_clock(judgement.uri == kStatusUri ? kMeasuredStatusClock : kMeasuredReportClock, outcome.answer);
  }
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
