#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row.hpp"

namespace adit::alarms {

/// How well something is, by shape and colour.
enum class Level : std::uint8_t { Quiet, Good, Wait, Bad };
inline constexpr std::string_view kLevelWords[] = {"quiet", "good", "wait", "bad"};

/// Whether what a robot sends of one kind reaches the Command Post.
enum class Arrival : std::uint8_t {
  NotYet,       // it waits for its first
  UpToDate,     // nothing waits
  Arriving,     // something waits, and not for long
  Late,         // longer than taking turns explains
  Throttled,    // the Command Post answered 429
  Failing,      // the last try came to nothing
  NotArriving,  // and it has been so for long
  Refused,      // the Command Post would not have the last one
  Quiet,        // nothing new came for a while
  Silent,       // its robot says nothing any more, against its habit
};
inline constexpr std::string_view kArrivalWords[] = {"waiting",   "up to date", "arriving",     "late",
                                                     "throttled", "failing",    "not arriving", "refused",
                                                     "quiet",     "silent"};
constexpr std::string_view name_of(Arrival arrival) {
  return kArrivalWords[static_cast<std::size_t>(arrival)];
}

/// The times by which all faces judge, in seconds.
inline constexpr double kLateAfter = 10;       // and a turn of all that send
inline constexpr double kFailingAfter = 10;    // a failing one counts as not arriving
inline constexpr double kStuckAfter = 90;      // any counts as not arriving, or three times as long as late
inline constexpr double kQuietAfter = 60;      // nothing new was forwarded
inline constexpr double kStatusOldAfter = 15;  // what was heard of the run is no longer fresh

/// One robot's (or, with no name, the merged) traffic of one kind.
struct Stream {
  std::string kind = {};                 // "grid", "cloud", "state", "markers"
  std::string robot = {};                // ""
  std::optional<double> behind = {};     // seconds that the oldest news has waited; nothing: none waits
  std::optional<double> forwarded = {};  // age in seconds of the newest data that was delivered
  std::optional<double> no_room = {};    // seconds since the robot was refused, because too much waits
  int last_status = 0;
  bool failed = false;  // the last try has a sentence why it came to nothing
  bool is_map() const { return kind == "grid" || kind == "cloud"; }
};

/// `turn`: seconds within which each of all maps that wait has its turn. `silent`: its robot is.
Arrival arrival_of(const Stream& stream, double turn, bool silent);
Level level_of(Arrival arrival);

}  // namespace adit::alarms

namespace adit::codec {

template <>
struct KindOf<alarms::Level> : KindOfWords<alarms::Level, alarms::kLevelWords> {};
template <>
struct KindOf<alarms::Arrival> : KindOfWords<alarms::Arrival, alarms::kArrivalWords> {};

}  // namespace adit::codec
