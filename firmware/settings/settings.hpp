#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"
#include "dispatch/reports.hpp"
#include "icd/robot_name.hpp"
#include "icd/rules.hpp"
#include "lanes/clouds.hpp"
#include "lanes/precision.hpp"

namespace adit::settings {

/// An IPv4 or IPv6 address in its text form, and a port from 1 to 65535 (0 in team.listen: any free port).
struct Address {
  std::string address;
  std::uint16_t port = 0;
  friend bool operator==(const Address&, const Address&) = default;
};

/// Requests a second, each from 0.001 to 1000.
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
  std::string interface;     // "" : none (loopback); else at most 15 characters
  double budget_mbit = 100;  // of the link, over both endpoints (ICD 3)
  Rates rates;
  Timeouts timeouts;
  bool arrange_clouds = true;  // pack::CloudForm
  std::string course;          // the one in use, whose endpoints then count instead of these; "": none
};

struct Team {
  std::vector<Address> listen;  // at least one
  std::string interface;
  bool require_token = true;
  std::string origins;  // with spaces between them; whose pages need no token where it is not required
  std::uint32_t connections = 128, connections_per_address = 64;  // intake::Shares
};

/// Those in a text that has spaces between them.
std::vector<std::string_view> words(std::string_view text);

struct Reports {
  std::chrono::milliseconds answer_within{20000};  // a client that waits longer gets a truthful 503
  std::chrono::milliseconds doubt_for{10000};      // dispatch::Patience
  std::int64_t doubt_asks = 3;
  dispatch::Review review = dispatch::Review::Off;
  double near_metres = 5;
};

struct Queues {
  std::size_t map_bytes = 256u << 20;    // maps that may wait, in bytes held; above it: 429
  std::size_t merge_bytes = 32u << 20;   // points merged into one cloud at most
  std::size_t marker_bytes = 32u << 20;  // markers that may wait, in bytes held; above it: 429
  std::size_t markers_per_message = 2000;
  std::size_t marker_bytes_per_message = 1u << 20;
};

/// How long a run lasts; and what is kept of runs on the disk, beside their reports.
struct Runs {
  std::int64_t length_seconds = 3600;
  std::uint64_t run_bytes = std::uint64_t{64} << 20;   // of one run
  std::uint64_t all_bytes = std::uint64_t{512} << 20;  // of all runs; the oldest go first
};

/// When a robot counts as silent.
struct Alarms {
  std::chrono::milliseconds silent_for{30000};  // at least
  double silent_times = 5;                      // the time that it lets pass between two messages as a rule
};

/// GPIO lines of the four lights and the button, by name; no line at all: a simulated panel.
struct Panel {
  std::string chip;  // its name, label or path; "": whichever chip has a line of that name
  std::string health, scoring, mapping, attention;
  bool active_low = false;  // the lights
  std::string button;
  bool button_active_low = true;

  bool has_lights() const {
    return !health.empty() || !scoring.empty() || !mapping.empty() || !attention.empty();
  }
  bool is_simulated() const { return !has_lights() && button.empty(); }
};

/// A robot as it was registered (ICD 2).
struct Robot {
  std::string name;   // icd::RobotName
  std::string alias;  // what it calls itself, goes on under `name`; "": nothing else
  lanes::Clouds clouds = lanes::Clouds::Auto;
  lanes::Precision precision = lanes::Precision::Exact;  // of its clouds
  double voxel_metres = 0;  // of its clouds one point in each voxel of that edge is enough; 0: all are sent
};

/// One of the Command Posts of an event: its endpoints, switched by name.
struct Course {
  std::string name;
  Address scoring, mapping;
};

/// NTP on the team's network: room clock.
struct Clock {
  std::string ntp_server;  // an IPv4 address; "": none is asked
  bool serve_ntp = false;
};

/// How the box's own addresses are changed. They are not here: room network.
struct Network {
  std::chrono::milliseconds confirm_within{90000};  // then a change of them is reverted
  bool allow_overlap = false;                       // of the team's subnet with the Command Post's
};

/// The settings file, version 1. Everything but the addresses has a default. Tokens are never in it.
struct Settings {
  CommandPost command_post;
  std::vector<Course> courses;
  Team team;
  std::vector<Robot> robots;
  Network network;
  Clock clock;
  Reports reports;
  Queues queues;
  Runs runs;
  Alarms alarms;
  icd::Rules rules;
  Panel panel;
};

struct Error {
  std::string path;  // "command_post.scoring.port"; "" for the document itself
  std::string what;  // "expected 1 to 65535, got 99999"
  std::string sentence() const { return path.empty() ? what : path + ": " + what; }
};

/// All errors at once, in the order of the file; an unknown key is an error that names it and the keys there
/// are.
std::expected<Settings, std::vector<Error>> parse(std::string_view json);
std::expected<Settings, std::vector<Error>> parse(const codec::Value& root);

/// Of a file that Adit itself wrote, and perhaps a later one, of an update that was reverted: keys that
/// this version does not know are passed over.
struct Saved {
  Settings settings;
  std::vector<std::string> passed_over;  // the paths of these keys
};
std::expected<Saved, std::vector<Error>> parse_saved(std::string_view json);

/// The settings as they work while their course is in use: its endpoints are the Command Post's, and each
/// robot's alias is in the rules. Requires names of robots that RobotName takes, as parse() sees to it.
Settings in_use(Settings settings);

/// A robot's name for the ICD; parse() accepts no other names.
icd::RobotName name_of(const Robot& robot);

/// A setting of each robot that does not have its default.
template <class Setting>
std::map<icd::RobotName, Setting> by_robot(const std::vector<Robot>& robots, Setting Robot::* setting) {
  std::map<icd::RobotName, Setting> all;
  for (const Robot& robot : robots) {
    if (robot.*setting != Robot().*setting) all.emplace(name_of(robot), robot.*setting);
  }
  return all;
}

/// "a: what; b: what"
std::string sentence_of(const std::vector<Error>& errors);

}  // namespace adit::settings
