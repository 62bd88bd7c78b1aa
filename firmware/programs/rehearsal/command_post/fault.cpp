#include "rehearsal/command_post/fault.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/command_post/fields.hpp"
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

namespace {

constexpr int kMostTimes = 10'000;
constexpr int kMostOffset = 1'000'000;
constexpr int kMostSeconds = 3600;
constexpr int kMostRetryAfter = 2'000'000'000;
constexpr std::size_t kLongestName = 100;

/// A word as it was given: its name, and what stands behind the first '='.
struct Word {
  std::string_view name;
  std::optional<std::string_view> argument;
};

Word word_of(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return {text, std::nullopt};
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 80;
  std::string sentence = "'";
  return sentence.append(text.substr(0, longest)).append("'");
}

std::unexpected<std::string> wanted(const Word& word, std::string_view what) {
  return std::unexpected(std::string(word.name)
                             .append(": expected ")
                             .append(what)
                             .append(", got ")
                             .append(quoted(word.argument.value_or(""))));
}

template <class Value>
Told set_once(std::optional<Value>& place, Value value, const Word& word) {
  if (place) return std::unexpected(quoted(word.name) + " is given twice");
  place = value;
  return {};
}

Told take_seconds(const Word& word, std::optional<Fault::Seconds>& place) {
  const auto seconds = number_of<double>(word.argument.value_or(""), 0, kMostSeconds);
  if (!seconds) return wanted(word, "seconds from 0 to 3600, as in " + std::string(word.name) + "=2.5");
  return set_once(place, Fault::Seconds(*seconds), word);
}

/// The sign has to be there: it is an offset, not what is to be shown.
Told take_remaining(const Word& word, Fault& fault) {
  std::string_view text = word.argument.value_or("");
  const bool sign = text.starts_with('+') || text.starts_with('-');
  if (text.starts_with('+')) text.remove_prefix(text.starts_with("+-") ? 0 : 1);
  const auto offset = number_of<std::int64_t>(text, -kMostOffset, kMostOffset);
  if (!sign || !offset) return wanted(word, "an offset with its sign, as in remaining=+2");
  return set_once(fault.remaining, *offset, word);
}

Told take_effect(const Word& word, const Effect& effect, Fault& fault) {
  if (fault.effect != nullptr) {
    return std::unexpected(quoted(word.name) + " cannot happen to a request together with " +
                           quoted(fault.effect->word));
  }
  fault.effect = &effect;
  if (!word.argument) return {};
  if (word.name != "429") return std::unexpected(quoted(word.name) + " takes no '='");
  const auto times = number_of<int>(*word.argument, 1, kMostTimes);
  if (!times) return wanted(word, "how many requests, from 1 to 10000, as in 429=3");
  fault.times = *times;
  return {};
}

Told take(const Word& word, Fault& fault) {
  const std::string_view value = word.argument.value_or("");
  if (word.name == "record-after") return take_seconds(word, fault.record_after);
  if (word.name == "answer-after") return take_seconds(word, fault.answer_after);
  if (word.name == "for") return take_seconds(word, fault.lasts);
  if (word.name == "remaining") return take_remaining(word, fault);
  if (word.name == "robot") {
    if (value.empty() || value.size() > kLongestName) return wanted(word, "a robot's name, as in robot=ugv1");
    fault.robot = value;
    return {};
  }
  if (word.name == "retry-after") {
    const auto seconds = number_of<int>(value, 0, kMostRetryAfter);
    if (!seconds) return wanted(word, "whole seconds from 0 to 2000000000, as in retry-after=2");
    return set_once(fault.retry_after, *seconds, word);
  }
  if (word.name == "other-sender") {
    if (word.argument) return std::unexpected("'other-sender' takes no '='");
    fault.other_sender = true;
    return {};
  }
  const auto effects = known_effects();
  const auto found = std::ranges::find(effects, word.name, &Effect::word);
  if (found != effects.end()) return take_effect(word, *found, fault);
  std::string sentence = "no such fault: " + quoted(word.name) + "; there are ok";
  for (const Effect& effect : effects) sentence.append(", ").append(effect.word);
  return std::unexpected(sentence +
                         ", answer-after, record-after, remaining, other-sender, retry-after, for, robot");
}

}  // namespace

std::expected<Fault, std::string> read_fault(std::string_view words) {
  Fault fault;
  if (words == kOk) return fault;
  while (true) {
    const auto comma = words.find(',');
    if (const auto taken = take(word_of(words.substr(0, comma)), fault); !taken) {
      return std::unexpected(taken.error());
    }
    if (comma == std::string_view::npos) return fault;
    words.remove_prefix(comma + 1);
  }
}

std::string words_of(const Fault& fault) {
  std::string words;
  const auto add = [&words](std::string_view word) -> std::string& {
    if (!words.empty()) words += ',';
    return words.append(word);
  };
  if (fault.other_sender) add("other-sender");
  if (fault.remaining) {
    add(*fault.remaining < 0 ? "remaining=" : "remaining=+") += std::to_string(*fault.remaining);
  }
  if (fault.clock_stands) add("clock:constant");
  if (fault.record_after) add("record-after=") += text_of(fault.record_after->count());
  if (fault.answer_after) add("answer-after=") += text_of(fault.answer_after->count());
  if (fault.effect != nullptr) add(fault.effect->word);
  if (fault.times > 1) words.append("=").append(std::to_string(fault.times));
  if (fault.lasts) add("for=") += text_of(fault.lasts->count());
  if (!fault.robot.empty()) add("robot=") += fault.robot;
  if (fault.retry_after) add("retry-after=") += std::to_string(*fault.retry_after);
  return words.empty() ? std::string(kOk) : words;
}

namespace {

constexpr const char* kClock = "clock";
constexpr const char* kConstant = "constant";
constexpr const char* kRunning = "running";
constexpr const char* kTooMany = "at most 10000 faults can be queued";

std::optional<Aim> aim_named(std::string_view name) {
  const auto* const found = std::ranges::find(kAims, name);
  if (found == kAims.end()) return std::nullopt;
  return static_cast<Aim>(found - kAims.begin());
}

std::string no_such_aim(std::string_view name) {
  return "no such aim: " + quoted(name) + "; there are reports, status, mapping, clock";
}

/// Whether the fault may happen to the request of that body: one of its robot, or of any.
bool is_of(const Fault& fault, std::string_view body) {
  return fault.robot.empty() || body.find(fault.robot) != std::string_view::npos;
}

/// Reads the words of a fault of that aim, or of the clock. The error begins with `place`.
Told read_words(std::string_view aim, std::string_view words, const std::string& place, Orders& orders) {
  if (aim == kClock) {
    if (words != kConstant && words != kRunning)
      return std::unexpected(place + ": expected constant or running, got " + quoted(words));
    orders.clocks_stand = words == kConstant;
    return {};
  }
  const auto fault = read_fault(words);
  if (!fault) return std::unexpected(place + ": " + fault.error());
  orders.aimed.emplace_back(*aim_named(aim), *fault);
  return {};
}

/// "reports:record-then-drop", "clock:constant".
std::expected<Orders, std::string> read_order(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) {
    return std::unexpected("expected an aim and a fault, as in reports:record-then-drop, got '" +
                           std::string(text) + "'");
  }
  const std::string aim(text.substr(0, colon));
  if (!aim_named(aim) && aim != kClock) return std::unexpected(no_such_aim(aim));
  Orders orders;
  if (const auto read = read_words(aim, text.substr(colon + 1), aim, orders); !read)
    return std::unexpected(read.error());
  return orders;
}

/// {"reports": ["record-then-drop", "ok"], "clock": ["constant"]}.
std::expected<Orders, std::string> read_orders(const Json& told) {
  if (!told.is_object()) return std::unexpected(R"(expected an object, as in {"reports": ["drop"]})");
  Orders orders;
  for (const auto& [aim, list] : told.items()) {
    if (!aim_named(aim) && aim != kClock) return std::unexpected(no_such_aim(aim));
    if (!list.is_array()) return std::unexpected(aim + ": expected an array of faults");
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string place = aim + "[" + std::to_string(i) + "]";
      if (!list[i].is_string()) return std::unexpected(place + R"(: expected a text, as in "drop")");
      const auto read = read_words(aim, list[i].get_ref<const std::string&>(), place, orders);
      if (!read) return std::unexpected(read.error());
    }
  }
  return orders;
}

}  // namespace

Told Faults::obey(const Orders& orders) {
  const std::lock_guard lock(mutex_);
  std::size_t waiting = orders.aimed.size();
  for (const auto& queue : queues_) waiting += queue.size();
  if (waiting > kMost) return std::unexpected(kTooMany);
  for (const auto& [aim, fault] : orders.aimed) queue(aim).push_back(fault);
  clocks_stand_ = orders.clocks_stand.value_or(clocks_stand_);
  return {};
}

Told Faults::tell(std::string_view aim_and_fault) {
  const auto orders = read_order(aim_and_fault);
  return orders ? obey(*orders) : std::unexpected(orders.error());
}

Told Faults::tell_rate(std::string_view aim_fault_and_rate) {
  const auto equals = aim_fault_and_rate.rfind('=');
  const std::string_view text = equals == std::string_view::npos ? "" : aim_fault_and_rate.substr(equals + 1);
  const auto rate = number_of<double>(text, 0, 1);
  if (!rate) {
    return std::unexpected(
        "expected a rate from 0 to 1 at the end, as in reports:record-then-drop=0.1, got '" +
        std::string(aim_fault_and_rate) + "'");
  }
  const auto orders = read_order(aim_fault_and_rate.substr(0, equals));
  if (!orders) return std::unexpected(orders.error());
  if (orders->aimed.empty()) return std::unexpected(no_such_aim(kClock));
  const auto& [aim, fault] = orders->aimed.front();
  const std::lock_guard lock(mutex_);
  double sum = *rate;
  for (const Rate& other : rates_) sum += other.aim == aim ? other.rate : 0;
  if (sum > 1) {
    return std::unexpected(std::string(kAims[static_cast<std::size_t>(aim)]) +
                           ": the rates come to more than 1");
  }
  rates_.push_back({aim, fault, *rate});
  return {};
}

Told Faults::tell_all(const Json& told) {
  const auto orders = read_orders(told);
  return orders ? obey(*orders) : std::unexpected(orders.error());
}

void Faults::clear() {
  const std::lock_guard lock(mutex_);
  for (auto& queue : queues_) queue.clear();
  until_ = {};
  rates_.clear();
  remaining_offset_ = 0;
  clocks_stand_ = false;
}

/// One that is to happen to more than one request waits for the others, as if it had been told just now.
Fault Faults::at_random(Aim aim, std::string_view body, Clock::time_point now) {
  constexpr double part = 0x1p-53;  // the upper 53 bits as a number from 0 to 1
  if (std::ranges::find(rates_, aim, &Rate::aim) == rates_.end()) return {};
  double drawn = static_cast<double>(chance_() >> 11) * part;
  for (const Rate& rate : rates_) {
    if (rate.aim != aim) continue;
    if (drawn >= rate.rate) {
      drawn -= rate.rate;
      continue;
    }
    if (!is_of(rate.fault, body)) return {};
    if (rate.fault.times == 1 && !rate.fault.lasts) return rate.fault;
    queue(aim).push_front(rate.fault);
    return *from_queue(aim, body, now);
  }
  return {};
}

/// The first in the queue that has not lasted for its time, and whose robot's this is; nothing: none waits.
std::optional<Fault> Faults::from_queue(Aim aim, std::string_view body, Clock::time_point now) {
  auto& waiting = queue(aim);
  auto& until = until_[static_cast<std::size_t>(aim)];
  if (until && now >= *until) {
    waiting.pop_front();
    until.reset();
  }
  if (waiting.empty()) return std::nullopt;
  Fault& front = waiting.front();
  if (front.lasts && !until) until = now + std::chrono::duration_cast<Clock::duration>(*front.lasts);
  if (!is_of(front, body)) return Fault{};
  Fault fault = front;
  fault.times = 1;
  if (front.lasts) return fault;
  if (--front.times == 0) waiting.pop_front();
  return fault;
}

Fault Faults::next(Aim aim, std::string_view body, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto waited = from_queue(aim, body, now);
  Fault fault = waited ? *waited : at_random(aim, body, now);
  if (fault.remaining) {
    remaining_offset_ = *fault.remaining;
  } else if (aim == Aim::Status && remaining_offset_ != 0) {
    fault.remaining = remaining_offset_;
  }
  fault.clock_stands = clocks_stand_ && aim != Aim::Mapping;
  return fault;
}

OrderedJson Faults::left() const {
  const std::lock_guard lock(mutex_);
  OrderedJson left;
  for (std::size_t i = 0; i < kAims.size(); ++i) {
    OrderedJson& list = left[std::string(kAims[i])] = OrderedJson::array();
    for (const Fault& fault : queues_[i]) list.push_back(words_of(fault));
  }
  OrderedJson& rates = left["rates"] = OrderedJson::array();
  for (const Rate& rate : rates_) {
    rates.push_back({{"aim", kAims[static_cast<std::size_t>(rate.aim)]},
                     {"fault", words_of(rate.fault)},
                     {"rate", rate.rate}});
  }
  left["remaining_offset"] = remaining_offset_;
  left[kClock] = clocks_stand_ ? kConstant : kRunning;
  return left;
}

}  // namespace adit::rehearsal
