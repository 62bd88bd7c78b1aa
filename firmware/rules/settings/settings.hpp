#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"
#include "dispatch/reports.hpp"
#include "icd/robot_name.hpp"
#include "icd/rules.hpp"
#include "queues/clouds.hpp"

namespace adit::codec {
struct Row;
}

namespace adit::settings {

// Meaning and bounds of each member: the rows in keys.cpp.

/// An IPv4 or IPv6 address in its text form, and a port from 1 to 65535 (0 in team.listen: any free port).
struct Address {
  std::string address;
  std::uint16_t port = 0;
  friend bool operator==(const Address&, const Address&) = default;
  static const codec::Row kRow;
};

/// Requests per second, each from 0.001 to 1000.
struct Rates {
  double reports_hz = 1, status_hz = 1, map_hz = 1, state_hz = 1, markers_hz = 1;
};

struct Timeouts {
  std::chrono::milliseconds connect{3000};
  std::chrono::milliseconds scoring_answer{10000};  // from the last byte sent to the last byte of the answer
  std::chrono::milliseconds mapping_answer{30000};
};

struct CommandPost {
  Address scoring, mapping;
  std::string interface;     // "": unset (loopback); else at most 15 characters
  double budget_mbit = 100;  // of the link, shared by both endpoints (ICD 3)
  Rates rates;
  Timeouts timeouts;
  bool arrange_clouds = true;  // pack::CloudForm
  std::string course;          // in use; its endpoints replace these; "": unset
};

struct Team {
  std::vector<Address> listen;  // at least one
  std::string interface;
  bool require_token = true;
  std::string origins;  // separated by spaces; their pages need no token if `require_token` is false
  std::uint32_t connections = 128, connections_per_address = 64;  // intake::Shares
};

/// The words of a text that are separated by spaces.
std::vector<std::string_view> words(std::string_view text);

struct Reports {
  std::chrono::milliseconds answer_within{20000};  // a client that has waited so long gets 503
  std::chrono::milliseconds doubt_for{10000};      // dispatch::InquiryPolicy
  std::int64_t doubt_asks = 3;
  dispatch::Review review = dispatch::Review::Off;
  double near_metres = 5;
  std::chrono::seconds undo{0};  // dispatch::ReportRules
};

struct Queues {
  std::size_t map_bytes = 256u << 20;    // queued maps in bytes; beyond that: 429
  std::size_t merge_bytes = 32u << 20;   // most bytes of points merged into one cloud
  std::size_t marker_bytes = 32u << 20;  // queued markers in bytes; beyond that: 429
  std::size_t markers_per_message = 2000;
  std::size_t marker_bytes_per_message = 1u << 20;
};

/// The length of a run, and the limits of stored runs without their reports.
struct Runs {
  std::int64_t length_seconds = 3600;
  std::uint64_t run_bytes = std::uint64_t{64} << 20;   // for one run
  std::uint64_t all_bytes = std::uint64_t{512} << 20;  // for all runs; the oldest are deleted first
};

/// Limits of a robot's silence.
struct Alarms {
  std::chrono::milliseconds silent_for{30000};  // at least
  double silent_times = 5;                      // multiple of the robot's usual gap between messages
};

/// GPIO lines of the four lights and the button, by name. Without any line the panel is simulated.
struct Panel {
  std::string chip;  // name, label or path; "": any chip with such a line
  std::string health, scoring, mapping, attention;
  bool active_low = false;  // of the lights
  std::string button;
  bool button_active_low = true;

  bool has_lights() const {
    return !health.empty() || !scoring.empty() || !mapping.empty() || !attention.empty();
  }
  bool is_simulated() const { return !has_lights() && button.empty(); }
  friend bool operator==(const Panel&, const Panel&) = default;
  static const codec::Row kRow;
};

/// A robot's colours on the pages and in the run's report. Word n is the colour of the robot whose first pose
/// in the run is number n, if no robot has chosen that colour (site/files/robot_colour.js).
inline constexpr std::string_view kColourWords[] = {
    "auto", "coral", "jade", "lavender", "copper", "aqua", "purple", "sand", "teal", "orchid", "olive",
    "cyan", "plum",  "lime", "azure",    "pink",   "moss", "sky",    "rose", "leaf", "blue"};

/// A registered robot (ICD 2).
struct Robot {
  std::string name;   // icd::RobotName
  std::string alias;  // the name in its messages, replaced by `name`; "": unset
  queues::Clouds clouds = queues::Clouds::Auto;
  queues::Precision precision = queues::Precision::Exact;  // for its clouds
  std::uint8_t colour = 0;  // index of kColourWords; 0: by the order of the first poses
  static const codec::Row kRow;
};

/// One of an event's Command Posts, selected by name.
struct Course {
  std::string name;
  Address scoring, mapping;
  static const codec::Row kRow;
};

/// NTP on the team's network: room clock.
struct Clock {
  std::string ntp_server;  // IPv4 address; "": unset
  bool serve_ntp = false;
};

/// The page and the API.
struct Page {
  bool https_only = false;  // while HTTPS is offered: browsers get no answer without it
};

/// Rules for changes of the box's addresses. The addresses themselves: room network.
struct Network {
  std::chrono::milliseconds confirm_within{90000};  // time until an unconfirmed change is reverted
  bool allow_overlap = false;                       // of the team's subnet with the Command Post's networks
};

/// The settings file, version 1. All but the addresses have defaults. It never holds tokens.
struct Settings {
  CommandPost command_post;
  std::vector<Course> courses;
  Team team;
  std::vector<Robot> robots;
  Network network;
  Page page;
  Clock clock;
  Reports reports;
  Queues queues;
  Runs runs;
  Alarms alarms;
  icd::Rules rules;
  Panel panel;
  std::vector<std::string> without_effect;  // paths of an earlier version's keys; never written
  static const codec::Row kRow;
};

struct Error {
  std::string path;     // "command_post.scoring.port"; "" for the document itself
  std::string what;     // "expected 1 to 65535, got 99999"
  std::string at = {};  // "line 3, column 15" of the key in a text; "": there is no text
  std::string sentence() const {
    return (at.empty() ? "" : at + ": ") + (path.empty() ? "" : path + ": ") + what;
  }
};

/// For a file that people edit: sets Error::at, the place in `json` of each key, or of the object without it.
void find_places(std::string_view json, std::vector<Error>& errors);

/// Returns all errors at once, in the file's order. An unknown key is an error, which lists the known keys.
std::expected<Settings, std::vector<Error>> parse(std::string_view json);
std::expected<Settings, std::vector<Error>> parse(const codec::Value& root);

/// Settings that Adit wrote, perhaps a later version before an update was reverted. Unknown keys are skipped.
struct SavedSettings {
  Settings settings;
  std::vector<std::string> passed_over;  // paths of unknown keys
};
std::expected<SavedSettings, std::vector<Error>> parse_saved(std::string_view json);

/// The settings in effect: the endpoints of the course in use, and the robots' aliases in the rules. Requires
/// valid robot names (icd::RobotName), which parse() ensures.
Settings effective_settings(Settings settings);

/// A robot's name for the ICD; parse() accepts no other names.
icd::RobotName name_of(const Robot& robot);

/// The values of a setting by robot, without defaults.
template <class Setting>
std::map<icd::RobotName, Setting> map_by_robot(const std::vector<Robot>& robots, Setting Robot::* setting) {
  std::map<icd::RobotName, Setting> all;
  for (const Robot& robot : robots) {
    if (robot.*setting != Robot().*setting) all.emplace(name_of(robot), robot.*setting);
  }
  return all;
}

/// "a: what; b: what"
std::string sentence_of(const std::vector<Error>& errors);

/// The parts of a running gateway that restart for new settings. All others continue with the new values.
struct Restarts {
  bool listeners = false;  // the team's sockets
  bool scoring = false;    // the scoring connection, and the known state of the run
  bool mapping = false;    // the mapping connections
  bool panel = false;      // the lines of lights and button
  friend bool operator==(const Restarts&, const Restarts&) = default;
};

/// `running`, `next`: from effective_settings().
Restarts restarts_by(const Settings& running, const Settings& next);

}  // namespace adit::settings
