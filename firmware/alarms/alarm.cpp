#include "alarms/alarm.hpp"

namespace adit::alarms {
namespace {

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
    member<&Alarm::why>("why", "a short sentence; may be empty"),
    member<&Alarm::action>("action"),
    member<&Alarm::acknowledged>("acknowledged", "an operator has seen it; no more once it is worse"),
    member<&Alarm::hides>("hides", "how many others follow from it, and are not listed"),
};

constexpr Member kOver[] = {
    member<&Over::id>("id"),
    member<&Over::severity>("severity").one_of(kSeverityWords),
    member<&Over::side>("side").one_of(kSideWords),
    member<&Over::was>("was", "what it was"),
    member<&Over::since>("since", kSeconds),
    member<&Over::until>("until", kSeconds),
};

constexpr std::string_view kById[] = {"id"}, kByIdAndEnd[] = {"id", "until"};

}  // namespace

constexpr codec::Row Action::kRow = {"", kAction};
constexpr codec::Row Alarm::kRow = {"Alarm", kAlarm, "A fault, a warning, or a decision to make.", kById};
constexpr codec::Row Over::kRow = {"AlarmOver", kOver, "An alarm that went.", kByIdAndEnd};

}  // namespace adit::alarms
