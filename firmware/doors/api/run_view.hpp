#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/arrival.hpp"
#include "alarms/verdict.hpp"
#include "api/scene.hpp"
#include "codec/row.hpp"
#include "dispatch/report.hpp"
#include "icd/geometry.hpp"
#include "icd/scoring.hpp"

namespace adit::api {

// Meaning and bounds of each member: descriptions in run_view.cpp.

/// The API's names of the endpoints.
inline constexpr std::string_view kEndpoints[] = {"scoring", "mapping"};

/// An artifact report and its state.
struct ReportRow {
  std::int64_t number = 0;
  std::string type;
  std::optional<icd::Point> position = icd::Point{};
  std::string sender, robot;
  Time received = 0, changed = 0;
  std::string state;
  int status = 0;
  std::string report_status;
  std::optional<std::int64_t> score_change;
  std::string note;
  std::int64_t run = 1;
  bool asking = false;
  std::optional<Time> sends_at = {};
  bool reconciled = false;
  std::int64_t same_as = 0;

  static const codec::Row kRow;
};

/// Number of reports by state.
struct ReportCounts {
  std::array<std::uint64_t, std::size(dispatch::kStateWords)> in{};  // by state
  std::uint64_t asking = 0;
};

/// A step in a report's history.
struct ReportStep {
  Time at = 0;
  std::string state, note;

  static const codec::Row kRow;
};

struct ReportDetail {
  ReportRow row;
  std::vector<ReportStep> history;
  std::string answer;

  static const codec::Row kRow;
};

/// Traffic of one kind from one robot, or merged (no name).
struct ActivityRow {
  std::string kind, robot;
  std::uint64_t accepted = 0, forwarded = 0, replaced = 0, merged = 0, throttled = 0, failed = 0,
                refused_upstream = 0, no_room = 0, queued = 0;
  std::optional<Time> behind_since, last_accepted, last_forwarded, last_no_room;
  std::optional<double> behind, age;  // from add_verdicts()
  std::uint64_t bytes_received = 0, bytes_sent = 0;
  int last_status = 0;
  std::string last_sentence;
  std::string clouds, precision;
  std::uint64_t no_valid_point = 0, invisible = 0;
  alarms::Arrival arrival = alarms::Arrival::NotYet;
  alarms::Level level = alarms::Level::Quiet;
  std::string word = {};  // from add_verdicts()

  static const codec::Row kRow;
};

/// A robot's state by its data.
struct StandingRow {
  std::string name;
  alarms::Level level = alarms::Level::Quiet;
  std::string word = {};
  bool silent = false, has_map = false;
  std::optional<double> age = {};

  static const codec::Row kRow;
};

/// A message that Adit refused.
struct RefusalRow {
  Time at = 0;
  std::string uri, sender;
  int status = 0;
  std::string sentence;
  std::uint64_t parts = 0;
  std::string setting = "";

  static const codec::Row kRow;
};

struct EndpointRow {
  std::string name = {}, address = {};
  bool connected = false;
  std::string trouble = {};
  int last_status = 0;
  std::optional<double> answer_ms = {};
  std::uint64_t throttled = 0, foreign = 0;
  alarms::Level level = alarms::Level::Quiet;
  std::string word = {};  // from add_verdicts()

  static const codec::Row kRow;
};

/// A map, state or markers that the Command Post rejected, or a map that was put aside (status 0), stored
/// until it is sent again or discarded.
struct RejectedRow {
  std::uint64_t number = 0;
  std::string kind, robot;
  Time at = 0;
  int status = 0;
  std::string why;
  std::size_t bytes = 0;
  bool replaced = false;

  static const codec::Row kRow;
};

/// A robot's pose at the Command Post.
struct RobotRow {
  std::string name;
  icd::Point position;
  double heading = 0;
  std::optional<Time> at = {};     // nullopt: before the boot, when the clock may have been different
  std::optional<double> age = {};  // from add_verdicts()

  static const codec::Row kRow;
};

/// A colour that the settings give a robot.
struct ColourRow {
  std::string name;
  int colour = 0;

  static const codec::Row kRow;
};

struct LightRow {
  std::string name, pattern;

  static const codec::Row kRow;
};

/// One of the two cables.
struct LinkRow {
  std::string side, interface;
  std::optional<bool> carrier;

  static const codec::Row kRow;
};

/// The data for the page, `adit status` and tests.
struct RunView {
  Time now = 0;
  std::string version;
  std::optional<icd::RunStatus> run;
  std::optional<alarms::ShownClock> run_clock;
  std::int64_t run_number = 1;
  std::string run_id;
  std::int64_t run_seconds = 3600;
  std::vector<EndpointRow> endpoints;
  std::vector<RobotRow> robots;
  std::vector<ReportRow> reports;
  double near_metres = 0;
  std::vector<ActivityRow> activities;
  std::vector<StandingRow> standings;
  std::vector<ColourRow> colours = {};
  std::vector<RefusalRow> refusals;
  std::vector<RejectedRow> rejected;
  std::vector<LightRow> lights;
  std::vector<LinkRow> links;
  std::optional<Time> identify_until, setup_open_until;
  double budget_mbit = 0, sent_mbit = 0;
  std::size_t queued_bytes = 0;
  std::uint64_t map_version = 0, marker_version = 0;
  alarms::Verdict verdict;
  std::vector<alarms::Alarm> alarms;
  std::vector<alarms::EndedAlarm> alarms_over;

  static const codec::Row kRow;
};

}  // namespace adit::api
