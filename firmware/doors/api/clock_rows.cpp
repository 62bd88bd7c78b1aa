#include "api/clock.hpp"
#include "clock/messages.hpp"

namespace adit::api {
namespace {

constexpr codec::Member kClockMembers[] = {
    codec::member<&ClockView::now>("now", "seconds since 1970"),
    codec::member<&ClockView::managed>("managed", "whether the clock can be set here"),
    codec::member<&ClockView::why>("why", "why the clock cannot be set here"),
    codec::member<&ClockView::source>("source",
                                      "source that set the clock last since the boot; null if not managed")
        .one_of(clock::kSourceWords),
    codec::member<&ClockView::is_set>("is_set", "whether the time is known well enough"),
    codec::member<&ClockView::refusal>("refusal", "why the last change failed"),
    codec::member<&ClockView::ntp>(
        "ntp", "state of NTP, or why it does not work; empty if the settings have no NTP"),
    codec::member<&ClockView::is_kept>("is_kept",
                                       "whether an NTP server keeps the time, so that no user can set it"),
};

}  // namespace

constexpr codec::Row ClockView::kRow = {"Clock", kClockMembers};

}  // namespace adit::api
