#include "rehearsal/command_post/misbehave.hpp"

#include <array>
#include <functional>

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/json.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {
namespace {

/// Neither a status line nor the start of one.
constexpr std::string_view kGarbage("\x16\x03\x01\x00\x05this is no HTTP\r\n\r\n\0\xff", 26);

constexpr std::string_view kServerError = "Server Error (500)";

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

/// 401 and 429, as the endpoint itself says them.
Outcome refusal(int status, const Spoilt& spoilt) {
  const bool unauthorized = status == 401;
  if (spoilt.manner == Manner::Strict) return refused(status, unauthorized ? kWrongToken : kTooManyRequests);
  if (spoilt.aim == Aim::Mapping) {
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

Outcome half(const Spoilt& spoilt) {
  std::string bytes = bytes_of(spoilt.outcome, false, std::chrono::system_clock::now());
  bytes.resize(bytes.size() / 2);
  return broken(std::move(bytes));
}

constexpr std::size_t kMuch = std::size_t{4} << 20;
constexpr std::string_view kOkLine = "HTTP/1.1 200 OK\r\n", kJsonType = "Content-Type: application/json\r\n";

/// A 200 of JSON with these bytes behind its first lines, where further header fields may follow.
Outcome json_then(const std::string& bytes) {
  return broken(std::string(kOkLine).append(kJsonType).append(bytes));
}

using In = const Spoilt&;

constexpr auto kEffects = std::to_array<Effect>({
    {"drop", false, [](In) { return broken(""); }},
    {"record-then-drop", true, [](In) { return broken(""); }},
    {"half-answer", true, half},
    {"reset", true, [](In) { return broken("", After::Reset); }},
    {"reset-unrecorded", false, [](In) { return broken("", After::Reset); }},
    {"garbage", true, [](In) { return broken(std::string(kGarbage)); }},
    {"401", false, [](In spoilt) { return refusal(401, spoilt); }},
    {"429", false, [](In spoilt) { return refusal(429, spoilt); }},
    {"500", false, [](In) { return page(500, kServerError); }},
    {"500-recorded", true, [](In) { return page(500, kServerError); }},
    {"repeat-answer", false, [](In spoilt) { return spoilt.outcome; }},
    {"html-200", false, [](In) { return portal(200); }},
    {"html-302", false, [](In) { return portal(302); }},
    {"html-400", false, [](In) { return portal(400); }},
    {"html-422", false, [](In) { return portal(422); }},
    // These would end a client that takes a peer at its word.
    {"length-huge", true, [](In) { return json_then("Content-Length: 30000000000\r\n\r\n{"); }},
    {"chunk-huge", true,
     [](In) { return broken(std::string(kOkLine) + "Transfer-Encoding: chunked\r\n\r\n6fc23ac00\r\n{"); }},
    {"header-flood", true,
     [](In) { return broken(std::string(kOkLine) + repeated("X-Flood: 0123456789\r\n", kMuch)); }},
    {"endless-body", true, [](In) { return json_then("\r\n[" + repeated("0,", kMuch)); }},
    {"1xx-flood", true, [](In) { return broken(repeated("HTTP/1.1 100 Continue\r\n\r\n", kMuch)); }},
    {"json-deep", true,
     [](In) {
       return json_then("Connection: close\r\nContent-Length: 15000\r\n\r\n" + std::string(15'000, '['));
     }},
});

/// Calls `change` with that member of the answer's body, if there is one.
void misstate(Answer& answer, const char* member, const std::function<void(OrderedJson&)>& change) {
  OrderedJson body = OrderedJson::parse(answer.body, nullptr, false);
  const auto shown = body.is_object() ? body.find(member) : body.end();
  if (shown == body.end()) return;
  change(*shown);
  answer.body = line_of(body);
}

}  // namespace

std::span<const Effect> known_effects() {
  return kEffects;
}

void spoil(const Fault& fault, Aim aim, Manner manner, Judgement& judgement) {
  Outcome& outcome = judgement.outcome;
  if (records(fault) && (outcome.kind != Outcome::Kind::Answered || outcome.answer.status == 0)) return;
  const bool is_status = aim == Aim::Status;
  if (fault.remaining && is_status) {
    misstate(outcome.answer, "remaining_reports",
             [&](OrderedJson& shown) { shown = shown.get<std::int64_t>() + *fault.remaining; });
  }
  if (fault.clock_stands) {
    misstate(outcome.answer, "run_clock",
             [&](OrderedJson& shown) { shown = is_status ? kMeasuredStatusClock : kMeasuredReportClock; });
  }
  if (fault.effect != nullptr) outcome = fault.effect->outcome_of({aim, manner, std::move(outcome)});
  if (fault.retry_after) {
    outcome.answer.headers.emplace_back("Retry-After", std::to_string(*fault.retry_after));
  }
}

}  // namespace adit::rehearsal
