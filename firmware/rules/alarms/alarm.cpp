#include "alarms/alarm.hpp"

#include <algorithm>
#include <cmath>

namespace adit::alarms {
namespace {

constexpr double kLongest = 1e9;  // seconds; a longer age comes from a clock step

std::int64_t to_seconds(double seconds) {
  return static_cast<std::int64_t>(std::floor(std::clamp(seconds, 0.0, kLongest)));
}

std::string two(std::int64_t number) {
  return (number < 10 ? "0" : "") + std::to_string(number);
}

using codec::member;
using codec::Member;

constexpr std::string_view kSeconds = "seconds since 1970";

constexpr Member kAction[] = {
    member<&Action::word>("word", "label of the button; empty if the alarm has no button"),
    member<&Action::link>("link", "where on the box's pages it is done"),
};

constexpr Member kAlarm[] = {
    member<&Alarm::id>("id", "the same as long as it lasts"),
    member<&Alarm::severity>("severity",
                             "bad: it does not work; ask: it waits for the operator's word; wait: it may "
                             "pass by itself")
        .one_of(kSeverityWords),
    member<&Alarm::side>("side", "where the cause is").one_of(kSideWords),
    member<&Alarm::subject>("subject", "the robot, endpoint or report that it is about; or empty"),
    member<&Alarm::since>("since", kSeconds),
    member<&Alarm::what>("what", "a headline"),
    member<&Alarm::why>("why", "the reason in at most 60 bytes; may be empty"),
    member<&Alarm::details>("details", "the whole reason if why is only its beginning, or empty"),
    member<&Alarm::action>("action"),
    member<&Alarm::acknowledged>("acknowledged", "an operator has seen it; no more once it is worse"),
    member<&Alarm::hides>("hides", "how many others follow from it, and are not listed"),
};

constexpr Member kOver[] = {
    member<&EndedAlarm::id>("id"),
    member<&EndedAlarm::severity>("severity").one_of(kSeverityWords),
    member<&EndedAlarm::side>("side").one_of(kSideWords),
    member<&EndedAlarm::was>("was", "what it was"),
    member<&EndedAlarm::since>("since", kSeconds),
    member<&EndedAlarm::until>("until", kSeconds),
};

constexpr std::string_view kById[] = {"id"}, kByIdAndEnd[] = {"id", "until"};

}  // namespace

std::string age_text(double seconds) {
  const std::int64_t all = to_seconds(seconds);
  if (all < 60) return std::to_string(all) + " s";
  if (all < 3600) return std::to_string(all / 60) + " min";
  return std::to_string(all / 3600) + ":" + two(all / 60 % 60) + " h";
}

std::string clock_text(double seconds) {
  const std::int64_t all = to_seconds(seconds);
  return std::to_string(all / 60) + ":" + two(all % 60);
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string reason_of(const std::string& why) {
  constexpr std::size_t kMost = 60;
  constexpr std::string_view kCut = "…";
  if (why.size() <= kMost) return why;
  std::size_t end = 0;
  for (const std::string_view mark : {": ", "; ", ", ", " ("}) {
    if (const auto at = why.rfind(mark, kMost); at != std::string::npos) end = std::max(end, at);
  }
  if (end > 0) return why.substr(0, end);
  end = why.rfind(' ', kMost - kCut.size());
  if (end == std::string::npos) end = kMost - kCut.size();
  while (end > 0 && (why[end] & 0xC0) == 0x80) --end;  // not within a letter
  return why.substr(0, end).append(kCut);
}

constexpr codec::Row Action::kRow = codec::complete<Action>({"", kAction});
constexpr codec::Row Alarm::kRow =
    codec::complete<Alarm>({"Alarm", kAlarm, "A fault, a warning, or a decision to make.", kById});
constexpr codec::Row EndedAlarm::kRow =
    codec::complete<EndedAlarm>({"AlarmOver", kOver, "An alarm that went.", kByIdAndEnd});

}  // namespace adit::alarms
