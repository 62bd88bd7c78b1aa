#pragma once

#include <cstdint>
#include <optional>

/// Where the time of day comes from: README.md.
namespace adit::clock {

/// Who set the time of day last; the later, the more he is trusted.
enum class Source : std::uint8_t {
  None,         // nobody: the machine began with it
  LastKnown,    // as it was when the power went
  Robots,       // their stamps
  CommandPost,  // the Date of its answers
  Chip,         // a clock with a battery of its own
  Operator,     // by his browser, or by `adit clock set`
  Ntp,          // a server on the team's network
};

/// Seconds since 1970: in 2026, before this was built, and in 2100. A clock that shows another time is wrong.
inline constexpr double kEarliest = 1767225600, kLatest = 4102444800;
/// Seconds by which robots may set it ahead: a box may have lain for a season.
inline constexpr double kRobotsMost = 200.0 * 86400;

/// That time is known well enough that nobody need be asked.
inline bool is_set(Source source) {
  return source >= Source::CommandPost;
}

struct Offer {
  Source source = Source::None;
  double time = 0;  // seconds since 1970, now
};

/// What the time of day is to be set to, where `present` set it last and it is `now`; nothing: it stays.
/// Whoever is trusted more sets it, either way, and after him the operator alone (who is asked whether the
/// NTP server keeps it: not here). What was known last sets it
/// ahead alone; so do robots, and not by more than kRobotsMost.
std::optional<double> to_be_set(Source present, const Offer& offer, double now);

}  // namespace adit::clock
