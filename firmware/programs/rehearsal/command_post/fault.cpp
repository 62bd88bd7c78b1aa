#include "rehearsal/command_post/fault.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace adit::rehearsal {
namespace {

using Action = Fault::Action;
using Taken = std::expected<void, std::string>;

struct ActionWord {
  std::string_view word;
  Action action;
};

constexpr std::array<ActionWord, 21> kActions = {{{"drop", Action::Drop},
                                                  {"record-then-drop", Action::RecordThenDrop},
                                                  {"half-answer", Action::HalfAnswer},
                                                  {"reset", Action::Reset},
                                                  {"reset-unrecorded", Action::ResetUnrecorded},
                                                  {"garbage", Action::Garbage},
                                                  {"401", Action::Unauthorized},
                                                  {"429", Action::TooMany},
                                                  {"500", Action::Fail},
                                                  {"500-recorded", Action::RecordThenFail},
                                                  {"repeat-answer", Action::RepeatAnswer},
                                                  {"html-200", Action::PageOk},
                                                  {"html-302", Action::PageElsewhere},
                                                  {"html-400", Action::PageBad},
                                                  {"html-422", Action::PageUnprocessable},
                                                  {"length-huge", Action::LengthHuge},
                                                  {"chunk-huge", Action::ChunkHuge},
                                                  {"header-flood", Action::HeaderFlood},
                                                  {"endless-body", Action::EndlessBody},
                                                  {"1xx-flood", Action::InterimFlood},
                                                  {"json-deep", Action::JsonDeep}}};

/// Of any action but Behave.
std::string_view word_for(Action action) {
  return std::ranges::find(kActions, action, &ActionWord::action)->word;
}

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

template <class Number>
std::optional<Number> number_of(std::string_view text, Number low, Number high) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!(number >= low && number <= high)) return std::nullopt;  // not a number is neither
  return number;
}

std::unexpected<std::string> wanted(const Word& word, std::string_view what) {
  return std::unexpected(std::string(word.name)
                             .append(": expected ")
                             .append(what)
                             .append(", got ")
                             .append(quoted(word.argument.value_or(""))));
}

template <class Value>
Taken set_once(std::optional<Value>& place, Value value, const Word& word) {
  if (place) return std::unexpected(quoted(word.name) + " is given twice");
  place = value;
  return {};
}

Taken take_seconds(const Word& word, std::optional<Fault::Seconds>& place) {
  const auto seconds = number_of<double>(word.argument.value_or(""), 0, kMostSeconds);
  if (!seconds) return wanted(word, "seconds from 0 to 3600, as in " + std::string(word.name) + "=2.5");
  return set_once(place, Fault::Seconds(*seconds), word);
}

/// The sign has to be there: it is an offset, not what is to be shown.
Taken take_remaining(const Word& word, Fault& fault) {
  std::string_view text = word.argument.value_or("");
  const bool sign = text.starts_with('+') || text.starts_with('-');
  if (text.starts_with('+')) text.remove_prefix(text.starts_with("+-") ? 0 : 1);
  const auto offset = number_of<std::int64_t>(text, -kMostOffset, kMostOffset);
  if (!sign || !offset) return wanted(word, "an offset with its sign, as in remaining=+2");
  return set_once(fault.remaining, *offset, word);
}

Taken take_action(const Word& word, Action action, Fault& fault) {
  if (fault.action != Action::Behave) {
    return std::unexpected(quoted(word.name) + " cannot happen to a request together with '" +
                           std::string(word_for(fault.action)) + "'");
  }
  fault.action = action;
  if (!word.argument) return {};
  if (action != Action::TooMany) return std::unexpected(quoted(word.name) + " takes no '='");
  const auto times = number_of<int>(*word.argument, 1, kMostTimes);
  if (!times) return wanted(word, "how many requests, from 1 to 10000, as in 429=3");
  fault.times = *times;
  return {};
}

Taken take(const Word& word, Fault& fault) {
  if (word.name == "record-after") return take_seconds(word, fault.record_after);
  if (word.name == "answer-after") return take_seconds(word, fault.answer_after);
  if (word.name == "for") return take_seconds(word, fault.lasts);
  if (word.name == "robot") {
    const std::string_view name = word.argument.value_or("");
    if (name.empty() || name.size() > kLongestName) return wanted(word, "a robot's name, as in robot=ugv1");
    fault.robot = name;
    return {};
  }
  if (word.name == "remaining") return take_remaining(word, fault);
  if (word.name == "retry-after") {
    const auto seconds = number_of<int>(word.argument.value_or(""), 0, kMostRetryAfter);
    if (!seconds) return wanted(word, "whole seconds from 0 to 2000000000, as in retry-after=2");
    return set_once(fault.retry_after, *seconds, word);
  }
  if (word.name == "other-sender") {
    if (word.argument) return std::unexpected("'other-sender' takes no '='");
    fault.other_sender = true;
    return {};
  }
  const auto* const found = std::ranges::find(kActions, word.name, &ActionWord::word);
  if (found != kActions.end()) return take_action(word, found->action, fault);
  std::string sentence = "no such fault: " + quoted(word.name) + "; there are ok";
  for (const ActionWord& action : kActions) sentence.append(", ").append(action.word);
  return std::unexpected(sentence +
                         ", answer-after, record-after, remaining, other-sender, retry-after, for, robot");
}

std::string text_of(double number) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  return {digits.data(), end};
}

}  // namespace

bool Fault::records() const {
  constexpr std::array unrecorded = {Action::Drop,
                                     Action::ResetUnrecorded,
                                     Action::Unauthorized,
                                     Action::TooMany,
                                     Action::Fail,
                                     Action::PageOk,
                                     Action::PageElsewhere,
                                     Action::PageBad,
                                     Action::PageUnprocessable,
                                     Action::RepeatAnswer};
  return std::ranges::find(unrecorded, action) == unrecorded.end();
}

std::expected<Fault, std::string> read_fault(std::string_view words) {
  Fault fault;
  if (words == "ok") return fault;
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
  if (fault.action != Action::Behave) add(word_for(fault.action));
  if (fault.times > 1) words.append("=").append(std::to_string(fault.times));
  if (fault.lasts) add("for=") += text_of(fault.lasts->count());
  if (!fault.robot.empty()) add("robot=") += fault.robot;
  if (fault.retry_after) add("retry-after=") += std::to_string(*fault.retry_after);
  return words.empty() ? "ok" : words;
}

}  // namespace adit::rehearsal
