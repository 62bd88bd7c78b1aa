#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row.hpp"

namespace adit::alarms {

/// A state for display, by shape and colour.
enum class Level : std::uint8_t { Quiet, Good, Wait, Bad };
inline constexpr std::string_view kLevelWords[] = {"quiet", "good", "wait", "bad"};
constexpr auto& words_of(Level /*of*/) {
  return kLevelWords;
}

/// Whether a robot's messages of one kind reach the Command Post.
enum class Arrival : std::uint8_t {
  NotYet,       // the first message has not come
  UpToDate,     // the queue is empty
  Arriving,     // queued, for a normal time
  Late,         // queued for longer than the turns of others explain
  Throttled,    // the Command Post answered 429
  Failing,      // the last attempt failed
  NotArriving,  // failing for long
  Refused,      // the Command Post rejected the last message
  Quiet,        // no new message for a while
  Silent,       // the robot has stopped sending, against its habit
};
inline constexpr std::string_view kArrivalWords[] = {"waiting",   "up to date", "arriving",     "late",
                                                     "throttled", "failing",    "not arriving", "refused",
                                                     "quiet",     "silent"};
constexpr auto& words_of(Arrival /*of*/) {
  return kArrivalWords;
}
constexpr std::string_view name_of(Arrival arrival) {
  return kArrivalWords[static_cast<std::size_t>(arrival)];
}

/// Time limits of all faces, in seconds.
inline constexpr double kLateAfter = 10;       // in addition to one turn of all senders
inline constexpr double kFailingAfter = 10;    // failing then becomes "not arriving"
inline constexpr double kStuckAfter = 90;      // any late stream becomes "not arriving", or after three times
                                               // the late limit
inline constexpr double kQuietAfter = 60;      // since the last new message was forwarded
inline constexpr double kStatusOldAfter = 15;  // age at which a status of the run is old

/// Traffic of one kind from one robot, or merged (no name).
struct Stream {
  std::string kind = {};                 // "grid", "cloud", "state", "markers"
  std::string robot = {};                // "" for the merged map
  std::optional<double> behind = {};     // seconds that the oldest message has been queued; nullopt: none is
  std::optional<double> forwarded = {};  // age in seconds of the newest delivered data
  std::optional<double> no_room = {};    // seconds since a message was rejected because the queue was full
  int last_status = 0;
  bool failed = false;  // the last attempt failed with a sentence
  bool is_map() const { return kind == "grid" || kind == "cloud"; }
};

/// `turn`: seconds in which each queued map has its turn. `silent`: of the stream's robot.
Arrival arrival_of(const Stream& stream, double turn, bool silent);
Level level_of(Arrival arrival);

/// The run's clock as all faces show it.
struct ShownClock {
  double seconds = 0;  // run time now
  double age = 0;      // seconds since the status was received
  bool runs = false;   // `seconds` advances
  bool old = false;    // the status is old; if `runs`, `seconds` is an estimate

  static const codec::Row kRow;
  friend bool operator==(const ShownClock&, const ShownClock&) = default;
};

/// The run's clock between two statuses. All times are monotonic seconds.
class RunClock {
 public:
  /// Call for each status. `shows`: its clock.
  void heard(double shows, double now);
  /// The clock at `now`, or std::nullopt before the first status. A clock advances unless it is at 0 s, or
  /// two statuses more than 1.5 s apart show the same time.
  std::optional<ShownClock> at(double now) const;

 private:
  struct Heard {
    double shows = 0, at = 0;
    bool runs = false;
  };
  std::optional<Heard> heard_;
};

}  // namespace adit::alarms
