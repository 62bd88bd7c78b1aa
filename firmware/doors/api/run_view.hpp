#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/arrival.hpp"
#include "alarms/verdict.hpp"
#include "api/scene.hpp"
#include "codec/row.hpp"
#include "dispatch/report.hpp"
#include "facts/rows.hpp"
#include "icd/scoring.hpp"

namespace adit::api {

// Meaning and bounds of each member: descriptions in run_view.cpp.

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
  facts::ReportRow row;
  std::vector<ReportStep> history;
  std::string answer;

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

/// The data for the page, `adit status` and tests.
struct RunView {
  static constexpr std::size_t kMostReports = 200;  // rows

  Time now = 0;
  std::string version;
  std::optional<icd::RunStatus> run;
  std::optional<alarms::ShownClock> run_clock;
  std::int64_t run_number = 1;
  std::string run_id;
  std::int64_t run_seconds = 3600;
  std::vector<facts::EndpointRow> endpoints;
  std::vector<facts::RobotRow> robots;
  std::vector<facts::ReportRow> reports;
  double near_metres = 0;
  std::vector<facts::ActivityRow> activities;
  std::vector<facts::StandingRow> standings;
  std::vector<ColourRow> colours = {};
  std::vector<facts::RefusalRow> refusals;
  std::vector<facts::RejectedRow> rejected;
  std::vector<LightRow> lights;
  std::vector<facts::LinkRow> links;
  std::string certificate = {};
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
