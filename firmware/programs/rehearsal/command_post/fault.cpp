#include "rehearsal/command_post/fault.hpp"

#include <algorithm>
#include <functional>

#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "rehearsal/command_post/server.hpp"
#include "rehearsal/common.hpp"

namespace adit::rehearsal {

/// A request whose answer is to be spoiled.
struct SpoiledRequest {
  Aim aim;
  Manner manner;
  Outcome outcome;  // as it was judged; if it was not, the last good answer to its aim
};

struct Effect {
  std::string_view word;
  bool records;  // the request is judged
  Outcome (*outcome_of)(const SpoiledRequest& spoilt);
};

namespace {

/// Neither a status line nor the start of one.
constexpr std::string_view kGarbage("\x16\x03\x01\x00\x05this is no HTTP\r\n\r\n\0\xff", 26);

constexpr std::string_view kServerError = "Server Error (500)";

/// As a captive portal says it, or a server that is none of the ICD's.
Outcome portal(int status) {
  Outcome outcome = page(status, "Log in to the network");
  outcome.after = ConnectionAction::Close;
  if (status == 302) outcome.answer.headers.emplace_back("Location", "http://192.0.2.1/login");
  return outcome;
}

std::string repeat(std::string_view text, std::size_t bytes) {
  std::string all;
  while (all.size() < bytes) all += text;
  return all;
}

/// 401 and 429, as the endpoint itself says them.
Outcome refusal(int status, const SpoiledRequest& spoilt) {
  const bool unauthorized = status == 401;
  if (spoilt.manner == Manner::Strict)
    return answer_refusal(status, unauthorized ? kWrongToken : kTooManyRequests);
  if (spoilt.aim == Aim::Mapping) {
    Outcome outcome = answer_refusal(status, unauthorized ? kWrongToken : kTooManyClouds);
    outcome.after = ConnectionAction::CloseThoughPromisingNot;
    return outcome;
  }
  Outcome outcome = answer_with_detail(status, unauthorized ? kInvalidToken : kThrottled);
  if (unauthorized) outcome.answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  return outcome;
}

/// These bytes and no more; then the connection ends.
Outcome broken(std::string bytes, ConnectionAction after = ConnectionAction::Close) {
  return {.kind = Outcome::Kind::Breaks, .after = after, .bytes = std::move(bytes)};
}

Outcome half(const SpoiledRequest& spoilt) {
  std::string bytes = bytes_of(spoilt.outcome, false, std::chrono::system_clock::now());
  bytes.resize(bytes.size() / 2);
  return broken(std::move(bytes));
}

constexpr std::size_t kMuch = std::size_t{4} << 20;
constexpr std::string_view kOkLine = "HTTP/1.1 200 OK\r\n", kJsonType = "Content-Type: application/json\r\n";

/// A 200 of JSON with these bytes behind its first lines, where further header fields may follow.
Outcome json_with_tail(const std::string& bytes) {
  return broken(std::string(kOkLine).append(kJsonType).append(bytes));
}

using In = const SpoiledRequest&;

constexpr auto kEffects = std::to_array<Effect>({
    {"drop", false, [](In) { return broken(""); }},
    {"record-then-drop", true, [](In) { return broken(""); }},
    {"half-answer", true, half},
    {"reset", true, [](In) { return broken("", ConnectionAction::Reset); }},
    {"reset-unrecorded", false, [](In) { return broken("", ConnectionAction::Reset); }},
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
    {"length-huge", true, [](In) { return json_with_tail("Content-Length: 30000000000\r\n\r\n{"); }},
    {"chunk-huge", true,
     [](In) { return broken(std::string(kOkLine) + "Transfer-Encoding: chunked\r\n\r\n6fc23ac00\r\n{"); }},
    {"header-flood", true,
     [](In) { return broken(std::string(kOkLine) + repeat("X-Flood: 0123456789\r\n", kMuch)); }},
    {"endless-body", true, [](In) { return json_with_tail("\r\n[" + repeat("0,", kMuch)); }},
    {"1xx-flood", true, [](In) { return broken(repeat("HTTP/1.1 100 Continue\r\n\r\n", kMuch)); }},
    {"json-deep", true,
     [](In) {
       return json_with_tail("Connection: close\r\nContent-Length: 15000\r\n\r\n" + std::string(15'000, '['));
     }},
});

/// Calls `change` with that member of the answer's body, if there is one.
void change_member(Answer& answer, const char* member, const std::function<void(OrderedJson&)>& change) {
  OrderedJson body = OrderedJson::parse(answer.body, nullptr, false);
  const auto shown = body.is_object() ? body.find(member) : body.end();
  if (shown == body.end()) return;
  change(*shown);
  answer.body = line_of(body);
}

using icd::sentence;

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

std::string quote(std::string_view text) {
  constexpr std::size_t longest = 80;
  return sentence("'", text.substr(0, longest), "'");
}

/// Stores the parsed argument in its place, once. `example`: for the sentence about an invalid one.
template <class Place>
OrderResult put(const Word& word, const Place& read, std::string_view what, std::string_view example,
                Place& place) {
  if (!read) {
    return wrong(word.name, ": expected ", what, ", as in ", word.name, "=", example, ", got ",
                 quote(word.argument.value_or("")));
  }
  if (place) return wrong(quote(word.name), " is given twice");
  place = read;
  return {};
}

OrderResult put_seconds(const Word& word, std::optional<Fault::Seconds>& place) {
  const auto seconds = number_of<double>(word.argument.value_or(""), 0, 3600).transform([](double number) {
    return Fault::Seconds(number);
  });
  return put(word, seconds, "seconds from 0 to 3600", "2.5", place);
}

/// The sign is required, because the number is an offset and not the shown value.
std::optional<std::int64_t> offset_in(std::string_view text) {
  constexpr std::int64_t most = 1'000'000;
  if (!text.starts_with('+') && !text.starts_with('-')) return std::nullopt;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  return number_of(text, -most, most);
}

OrderResult put_effect(const Word& word, const Effect& effect, Fault& fault) {
  if (fault.effect != nullptr) {
    return wrong(quote(word.name), " cannot happen to a request together with ", quote(fault.effect->word));
  }
  fault.effect = &effect;
  if (!word.argument) return {};
  if (word.name != "429") return wrong(quote(word.name), " takes no '='");
  std::optional<int> times;
  ADIT_TRY(put(word, number_of(*word.argument, 1, 10'000), "how many requests, from 1 to 10000", "3", times));
  fault.times = *times;
  return {};
}

OrderResult put_word(const Word& word, Fault& fault) {
  constexpr std::size_t longest_name = 100;
  const std::string_view value = word.argument.value_or("");
  if (word.name == "record-after") return put_seconds(word, fault.record_after);
  if (word.name == "answer-after") return put_seconds(word, fault.answer_after);
  if (word.name == "for") return put_seconds(word, fault.lasts);
  if (word.name == "remaining")
    return put(word, offset_in(value), "an offset with its sign", "+2", fault.remaining);
  if (word.name == "robot") {
    const bool is_name = !value.empty() && value.size() <= longest_name;
    const auto name = is_name ? std::optional<std::string>(value) : std::nullopt;
    return put(word, name, "a robot's name", "ugv1", fault.robot);
  }
  if (word.name == "retry-after") {
    return put(word, number_of(value, 0, 2'000'000'000), "whole seconds from 0 to 2000000000", "2",
               fault.retry_after);
  }
  if (word.name == "other-sender") {
    if (word.argument) return wrong("'other-sender' takes no '='");
    fault.other_sender = true;
    return {};
  }
  const auto* const effect = std::ranges::find(kEffects, word.name, &Effect::word);
  if (effect != kEffects.end()) return put_effect(word, *effect, fault);
  return wrong("no such fault: ", quote(word.name), "; there are ok, ",
               icd::join_words(kEffects, &Effect::word),
               ", answer-after, record-after, remaining, other-sender, retry-after, for, robot");
}

/// Reads words with commas: "record-then-drop", "429=3,retry-after=2", "ok". An error names the word.
std::expected<Fault, std::string> read_fault(std::string_view words) {
  Fault fault;
  if (words == kOk) return fault;
  for (bool more = true; more;) {
    more = words.contains(',');
    ADIT_TRY(put_word(word_of(icd::cut(words, ',')), fault));
  }
  return fault;
}

constexpr const char *kClock = "clock", *kConstant = "constant", *kRunning = "running";

bool is_aim(std::string_view name) {
  return name == kClock || std::ranges::find(kAims, name) != kAims.end();
}

std::unexpected<std::string> no_such_aim(std::string_view name) {
  return wrong("no such aim: ", quote(name), "; there are reports, status, mapping, clock");
}

/// Whether the fault may happen to the request of that body: one of its robot, or of any.
bool matches_request(const Fault& fault, std::string_view body) {
  return !fault.robot || body.contains(*fault.robot);
}

/// Reads the words of a fault of that aim, or of the clock. The error begins with `place`.
OrderResult read_words(std::string_view aim, std::string_view words, const std::string& place,
                       Orders& orders) {
  if (aim == kClock) {
    if (words != kConstant && words != kRunning)
      return wrong(place, ": expected constant or running, got ", quote(words));
    orders.clocks_stand = words == kConstant;
    return {};
  }
  const auto fault = read_fault(words);
  if (!fault) return wrong(place, ": ", fault.error());
  orders.aimed.emplace_back(static_cast<Aim>(std::ranges::find(kAims, aim) - kAims.begin()), *fault);
  return {};
}

/// "reports:record-then-drop", "clock:constant".
std::expected<Orders, std::string> read_order(std::string_view text) {
  if (!text.contains(':'))
    return wrong("expected an aim and a fault, as in reports:record-then-drop, got '", text, "'");
  const std::string aim(icd::cut(text, ':'));
  if (!is_aim(aim)) return no_such_aim(aim);
  Orders orders;
  ADIT_TRY(read_words(aim, text, aim, orders));
  return orders;
}

/// {"reports": ["record-then-drop", "ok"], "clock": ["constant"]}.
std::expected<Orders, std::string> read_orders(const Json& told) {
  if (!told.is_object()) return wrong(R"(expected an object, as in {"reports": ["drop"]})");
  Orders orders;
  for (const auto& [aim, list] : told.items()) {
    if (!is_aim(aim)) return no_such_aim(aim);
    if (!list.is_array()) return wrong(aim, ": expected an array of faults");
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string place = sentence(aim, "[", i, "]");
      if (!list[i].is_string()) return wrong(place, R"(: expected a text, as in "drop")");
      ADIT_TRY(read_words(aim, list[i].get_ref<const std::string&>(), place, orders));
    }
  }
  return orders;
}

}  // namespace

bool records(const Fault& fault) {
  return fault.effect == nullptr || fault.effect->records;
}

void spoil(const Fault& fault, Aim aim, Manner manner, Judgement& judgement) {
  Outcome& outcome = judgement.outcome;
  if (records(fault) && (outcome.kind != Outcome::Kind::Answered || outcome.answer.status == 0)) return;
  const bool is_status = aim == Aim::Status;
  if (fault.remaining && is_status) {
    change_member(outcome.answer, "remaining_reports",
                  [&](OrderedJson& shown) { shown = shown.get<std::int64_t>() + *fault.remaining; });
  }
  if (fault.clock_stands) {
    change_member(outcome.answer, "run_clock", [&](OrderedJson& shown) {
      shown = is_status ? kMeasuredStatusClock : kMeasuredReportClock;
    });
  }
  if (fault.effect != nullptr) outcome = fault.effect->outcome_of({aim, manner, std::move(outcome)});
  if (fault.retry_after) {
    outcome.answer.headers.emplace_back("Retry-After", std::to_string(*fault.retry_after));
  }
}

std::string words_of(const Fault& fault) {
  std::string words;
  const auto add = [&words](const auto&... parts) {
    words.append(words.empty() ? "" : ",").append(sentence(parts...));
  };
  if (fault.other_sender) add("other-sender");
  if (fault.remaining) add(*fault.remaining < 0 ? "remaining=" : "remaining=+", *fault.remaining);
  if (fault.clock_stands) add("clock:constant");
  if (fault.record_after) add("record-after=", fault.record_after->count());
  if (fault.answer_after) add("answer-after=", fault.answer_after->count());
  if (fault.effect != nullptr) add(fault.effect->word);
  if (fault.times > 1) words.append(sentence("=", fault.times));
  if (fault.lasts) add("for=", fault.lasts->count());
  if (fault.robot) add("robot=", *fault.robot);
  if (fault.retry_after) add("retry-after=", *fault.retry_after);
  return words.empty() ? std::string(kOk) : words;
}

OrderResult Faults::obey(const Orders& orders) {
  const std::lock_guard lock(mutex_);
  std::size_t waiting = orders.aimed.size();
  for (const auto& queue : queues_) waiting += queue.size();
  if (waiting > kMost) return wrong("at most 10000 faults can be queued");
  for (const auto& [aim, fault] : orders.aimed) queue(aim).push_back(fault);
  clocks_stand_ = orders.clocks_stand.value_or(clocks_stand_);
  return {};
}

OrderResult Faults::add_order(std::string_view aim_and_fault) {
  const Orders orders = ADIT_TRY(read_order(aim_and_fault));
  return obey(orders);
}

OrderResult Faults::add_orders(const Json& told) {
  const Orders orders = ADIT_TRY(read_orders(told));
  return obey(orders);
}

OrderResult Faults::add_rate(std::string_view aim_fault_and_rate) {
  const std::size_t equals = aim_fault_and_rate.rfind('=');
  const auto rate = number_of<double>(aim_fault_and_rate.substr(equals + 1), 0, 1);  // npos + 1 is 0
  if (!rate) {
    return wrong("expected a rate from 0 to 1 at the end, as in reports:record-then-drop=0.1, got '",
                 aim_fault_and_rate, "'");
  }
  const Orders orders = ADIT_TRY(read_order(aim_fault_and_rate.substr(0, equals)));
  if (orders.aimed.empty()) return no_such_aim(kClock);
  const auto& [aim, fault] = orders.aimed.front();
  const std::lock_guard lock(mutex_);
  double sum = *rate;
  for (const Rate& other : rates_) sum += other.aim == aim ? other.rate : 0;
  if (sum > 1) return wrong(kAims[static_cast<std::size_t>(aim)], ": the rates come to more than 1");
  rates_.push_back({aim, fault, *rate});
  return {};
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
Fault Faults::random_fault(Aim aim, std::string_view body, Clock::time_point now) {
  constexpr double part = 0x1p-53;  // the upper 53 bits as a number from 0 to 1
  if (std::ranges::find(rates_, aim, &Rate::aim) == rates_.end()) return {};
  double drawn = static_cast<double>(chance_() >> 11) * part;
  for (const Rate& rate : rates_) {
    if (rate.aim != aim) continue;
    if (drawn >= rate.rate) {
      drawn -= rate.rate;
      continue;
    }
    if (!matches_request(rate.fault, body)) return {};
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
  if (!matches_request(front, body)) return Fault{};
  Fault fault = front;
  fault.times = 1;
  if (front.lasts) return fault;
  if (--front.times == 0) waiting.pop_front();
  return fault;
}

Fault Faults::next(Aim aim, std::string_view body, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto waited = from_queue(aim, body, now);
  Fault fault = waited ? *waited : random_fault(aim, body, now);
  if (fault.remaining) {
    remaining_offset_ = *fault.remaining;
  } else if (aim == Aim::Status && remaining_offset_ != 0) {
    fault.remaining = remaining_offset_;
  }
  fault.clock_stands = clocks_stand_ && aim != Aim::Mapping;
  return fault;
}

OrderedJson Faults::remaining() const {
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
