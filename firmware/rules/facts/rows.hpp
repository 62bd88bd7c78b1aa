#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row.hpp"
#include "icd/geometry.hpp"

namespace adit::facts {

// Meaning and bounds of each member: descriptions in rows.cpp.

/// Seconds since 1970 by the gateway's clock.
using Time = double;

/// At least 0.
double seconds_since(Time at, Time now);

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
                                                     "throttled", "failing",    "not arriving", "rejected",
                                                     "quiet",     "silent"};
constexpr auto& words_of(Arrival /*of*/) {
  return kArrivalWords;
}
constexpr std::string_view name_of(Arrival arrival) {
  return kArrivalWords[static_cast<std::size_t>(arrival)];
}

struct ReportRow {
  std::int64_t number = 0;
  std::string type = {};
  std::optional<icd::Point> position = icd::Point{};
  std::string sender = {}, robot = {};
  Time received = 0, changed = 0;
  std::string state = {};
  int status = 0;
  std::string report_status = {};
  std::optional<std::int64_t> score_change = {};
  std::string note = {};
  std::int64_t run = 1;
  bool asking = false;
  std::optional<Time> sends_at = {};
  bool reconciled = false;
  std::int64_t same_as = 0;

  static const codec::Row kRow;
};

/// The API's names of the kinds of messages.
inline constexpr std::string_view kKinds[] = {"grid", "cloud", "state", "markers"};

/// Traffic of one kind from one robot, or merged (no name).
struct ActivityRow {
  std::string kind = {}, robot = {};
  std::uint64_t accepted = 0, forwarded = 0, replaced = 0, merged = 0, throttled = 0, failed = 0,
                refused_upstream = 0, no_room = 0, queued = 0;
  std::optional<Time> behind_since = {}, last_accepted = {}, last_forwarded = {}, last_no_room = {};
  std::optional<double> age = {}, heard = {};  // from set_ages()
  std::uint64_t bytes_received = 0, bytes_sent = 0;
  int last_status = 0;
  std::string last_sentence = {};
  std::string clouds = {}, precision = {};
  std::uint64_t no_valid_point = 0, invisible = 0;
  Arrival arrival = Arrival::NotYet;
  Level level = Level::Quiet;
  std::string word = {};  // from alarms::add_words()

  bool is_map() const { return kind == "grid" || kind == "cloud"; }
  static const codec::Row kRow;
};

/// Sets age and heard at `now`.
void set_ages(ActivityRow& row, Time now);

/// A robot's state by its data.
struct StandingRow {
  std::string name = {};
  Level level = Level::Quiet;
  std::string word = {};
  bool silent = false, has_map = false;
  std::optional<double> age = {}, heard = {};

  static const codec::Row kRow;
};

/// A message that Adit refused.
struct RefusalRow {
  Time at = 0;
  std::string uri = {}, sender = {};
  int status = 0;
  std::string sentence = {};
  std::uint64_t parts = 0;
  std::string setting = "";

  static const codec::Row kRow;
};

/// The API's names of the endpoints.
inline constexpr std::string_view kEndpoints[] = {"scoring", "mapping"};

/// Fault of an endpoint or of the way to it, the worst first.
enum class EndpointFault : std::uint8_t {
  NoToken,      // no token is set; Adit does not connect
  Unreachable,  // no connection
  Foreign,      // another kind of server answers
  Refusing,     // 401 or 403
  Silent,       // accepts data and does not answer
  Failing,      // answers every request with 5xx or the like
  Throttling,   // repeated 429
  None,
};

struct EndpointRow {
  std::string name = {}, address = {};
  bool connected = false;
  std::string trouble = {};
  int last_status = 0;
  std::optional<double> answer_ms = {}, answered = {};
  std::uint64_t throttled = 0, foreign = 0;
  Level level = Level::Quiet;
  std::string word = {};  // from alarms::add_words()

  // For the alarms alone:
  EndpointFault fault = EndpointFault::None;
  Time since = 0;                       // start of the fault
  double waits = 0;                     // seconds since a request made any progress; 0: none is waiting
  std::string said = {};                // detail of the fault from the connection or the Command Post
  std::optional<double> well_for = {};  // seconds since it accepts again; nullopt: it was never stopped

  static const codec::Row kRow;
};

/// A message that the Command Post rejected, or a map that aditd put aside (status 0), kept for the operator.
struct RejectedRow {
  std::uint64_t number = 0;
  std::string kind = {}, robot = {};
  Time at = 0;
  int status = 0;
  std::string why = {};
  std::size_t bytes = 0;
  bool replaced = false;

  static const codec::Row kRow;
};

/// A robot's pose at the Command Post.
struct RobotRow {
  std::string name = {};
  icd::Point position = {};
  double heading = 0;
  std::optional<Time> at = {};     // nullopt: before the boot, when the clock may have been different
  std::optional<double> age = {};  // from alarms::add_words()

  static const codec::Row kRow;
};

/// One of the two cables.
struct LinkRow {
  std::string side = {}, interface = {};
  std::optional<bool> carrier = {};

  bool is_team() const { return side == "team"; }
  static const codec::Row kRow;
};

}  // namespace adit::facts
