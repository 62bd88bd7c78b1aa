#pragma once

#include <cstdint>
#include <optional>

/// Sources of the time of day: README.md.
namespace adit::clock {

/// In the order of trust, the least trusted first.
enum class Source : std::uint8_t {
  None,         // the time at boot
  LastKnown,    // stored before the power went
  Robots,       // time stamps of robots
  CommandPost,  // the Date header of its answers
  Chip,         // a clock with its own battery
  Operator,     // the operator's browser, or `adit clock set`
  Ntp,          // a server on the team's network
};

/// Seconds since 1970: the starts of 2026, before Adit was built, and of 2100. Other times are wrong.
inline constexpr double kEarliest = 1767225600, kLatest = 4102444800;
/// Most seconds by which robots may advance the clock: a box may be stored for a season.
inline constexpr double kRobotsMost = 200.0 * 86400;

/// Whether the time is reliable.
inline bool is_set(Source source) {
  return source >= Source::CommandPost;
}

struct Offer {
  Source source = Source::None;
  double time = 0;  // seconds since 1970, now
};

/// The time to set, or std::nullopt to leave the clock. `present` set the clock last; `now` is its time. A
/// more trusted source sets it in either direction, and the operator always does. LastKnown and Robots only
/// advance it, Robots by at most kRobotsMost. The caller checks whether an NTP server keeps the clock.
std::optional<double> to_be_set(Source present, const Offer& offer, double now);

}  // namespace adit::clock
