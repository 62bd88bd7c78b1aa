#include "api/clock.hpp"
#include "clock/messages.hpp"

namespace adit::api {
namespace {

constexpr codec::Member kClockMembers[] = {
    codec::member<&ClockView::now>("now", "seconds since 1970"),
    codec::member<&ClockView::managed>("managed", "it can be set here"),
    codec::member<&ClockView::why>("why", "why it cannot be"),
    codec::member<&ClockView::source>("source", "who set it last since the box started")
        .one_of(clock::kSourceWords),
    codec::member<&ClockView::is_set>("is_set", "it is known well enough"),
    codec::member<&ClockView::refusal>("refusal", "why the last change came to nothing"),
    codec::member<&ClockView::ntp>(
        "ntp", "what is done about NTP, or why it is not; empty where it is not asked for"),
    codec::member<&ClockView::is_kept>("is_kept", "an NTP server keeps it, and nobody else may set it"),
};

}  // namespace

constexpr codec::Row ClockView::kRow = {"Clock", kClockMembers};

}  // namespace adit::api
