#include "rehearsal/command_post/misbehave.hpp"

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/json.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {
namespace {

using Action = Fault::Action;

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

/// The bytes of the actions that would end a client which takes a peer at its word.
std::string overwhelming(Action action) {
  constexpr std::size_t kMuch = std::size_t{4} << 20;
  switch (action) {
    case Action::LengthHuge:
      return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: 30000000000\r\n\r\n{";
    case Action::ChunkHuge:
      return "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n6fc23ac00\r\n{";
    case Action::HeaderFlood:
      return "HTTP/1.1 200 OK\r\n" + repeated("X-Flood: 0123456789\r\n", kMuch);
    case Action::EndlessBody:
      return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n\r\n[" + repeated("0,", kMuch);
    case Action::InterimFlood:
      return repeated("HTTP/1.1 100 Continue\r\n\r\n", kMuch);
    case Action::JsonDeep: {
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

Outcome spoiled(Action action, const Request& request, Outcome decided) {
  switch (action) {
    case Action::Drop:
    case Action::RecordThenDrop:
      return broken("");
    case Action::Reset:
    case Action::ResetUnrecorded:
      return broken("", After::Reset);
    case Action::Garbage:
      return broken(std::string(kGarbage));
    case Action::RecordThenFail:
      return failure();
    case Action::HalfAnswer: {
      std::string bytes = bytes_of(decided, request.method == "HEAD", std::chrono::system_clock::now());
      bytes.resize(bytes.size() / 2);
      return broken(std::move(bytes));
    }
    case Action::LengthHuge:
    case Action::ChunkHuge:
    case Action::HeaderFlood:
    case Action::EndlessBody:
    case Action::InterimFlood:
    case Action::JsonDeep:
      return broken(overwhelming(action));
    case Action::Behave:
    case Action::Unauthorized:
    case Action::TooMany:
    case Action::Fail:
    case Action::PageOk:
    case Action::PageElsewhere:
    case Action::PageBad:
    case Action::PageUnprocessable:
    case Action::RepeatAnswer:
      break;
  }
  return decided;
}

/// Calls `change` with that member of the answer's body, if there is one.
void misstate(Answer& answer, const char* member, const std::function<void(OrderedJson&)>& change) {
  OrderedJson body = OrderedJson::parse(answer.body, nullptr, false);
  const auto shown = body.is_object() ? body.find(member) : body.end();
  if (shown == body.end()) return;
  change(*shown);
  answer.body = line_of(body);
}

}  // namespace

std::optional<Aim> scoring_aim(const Request& request, Manner manner) {
  std::string_view path = request.path;
  if (manner == Manner::AsMeasured) path = without_slash(path);
  if (request.fault) return std::nullopt;
  if (request.method == "POST" && path == kReportsUri) return Aim::Reports;
  if (request.method == "GET" && path == kStatusUri) return Aim::Status;
  return std::nullopt;
}

std::optional<Aim> mapping_aim(const Request& request) {
  if (request.fault || !names_one_of(request, kMappingFunctions)) return std::nullopt;
  return Aim::Mapping;
}

Judgement unjudged(const Fault& fault, Aim aim, const Request& request, Manner manner) {
  Judgement judgement;
  judgement.uri = aim == Aim::Mapping ? request.path : without_slash(request.path);
  if (aim == Aim::Reports) {  // so that the transcript shows which report came to nothing
    if (auto document = read_document(request.body, Format::JsonText)) judgement.message = document->value;
  }
  if (fault.action == Action::Unauthorized) judgement.outcome = refusal(401, aim, manner);
  if (fault.action == Action::TooMany) judgement.outcome = refusal(429, aim, manner);
  if (fault.action == Action::Fail) judgement.outcome = failure();
  if (fault.action == Action::PageOk) judgement.outcome = portal(200);
  if (fault.action == Action::PageElsewhere) judgement.outcome = portal(302);
  if (fault.action == Action::PageBad) judgement.outcome = portal(400);
  if (fault.action == Action::PageUnprocessable) judgement.outcome = portal(422);
  return judgement;
}

void spoil(const Fault& fault, const Request& request, Judgement& judgement) {
  Outcome& outcome = judgement.outcome;
  if (outcome.kind != Outcome::Kind::Answered || outcome.answer.status == 0) return;
  const bool is_status = judgement.uri == kStatusUri;
  if (fault.remaining && is_status) {
    misstate(outcome.answer, "remaining_reports",
             [&](OrderedJson& shown) { shown = shown.get<std::int64_t>() + *fault.remaining; });
  }
  if (fault.clock_stands) {
    misstate(outcome.answer, "run_clock",
             [&](OrderedJson& shown) { shown = is_status ? kMeasuredStatusClock : kMeasuredReportClock; });
  }
  outcome = spoiled(fault.action, request, std::move(outcome));
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
