#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "alarms/conditions.hpp"

namespace adit::alarms {

using facts::ActivityRow;
using facts::Arrival;
using facts::Crowd;
using facts::EndpointFault;
using facts::EndpointRow;
using facts::Level;
using facts::ReportRow;
using facts::RobotHabit;
using facts::Snapshot;

inline constexpr double kNow = 1'790'000'000;

inline std::vector<std::string> ids_of(const std::vector<Condition>& conditions) {
  std::vector<std::string> ids;
  for (const Condition& each : conditions) ids.push_back(each.id);
  return ids;
}

/// The condition with that id, or an empty one.
inline Condition find(const std::vector<Condition>& conditions, const std::string& id) {
  const auto found = std::ranges::find(conditions, id, &Condition::id);
  return found == conditions.end() ? Condition{} : *found;
}

/// Adds a report newer than the others.
inline void add_report(Snapshot& snapshot, ReportRow row) {
  snapshot.reports.rows.insert(snapshot.reports.rows.begin(), std::move(row));
}

/// A run without alarms: that many robots, each with a grid and poses.
inline Snapshot well(std::size_t robots = 2) {
  Snapshot snapshot{.traffic = {.now = kNow}};
  snapshot.traffic.endpoints = {{.name = "scoring", .address = "10.100.1.200:8000"},
                                {.name = "mapping", .address = "10.100.1.201:8000"}};
  snapshot.traffic.links = {{"team", "team0", true}, {"command_post", "darpa0", true}};
  snapshot.traffic.queue_room = 100u << 20;
  snapshot.reports.left = 45;
  snapshot.box.disk.free = 1u << 30;
  snapshot.box.time_set = true;
  for (std::size_t i = 1; i <= robots; ++i) {
    const std::string name = "uav" + std::to_string(i);
    snapshot.traffic.habits[name] = {.gap = 1, .quiet = 1};
    snapshot.traffic.activities.push_back({.kind = "grid",
                                           .robot = name,
                                           .last_forwarded = kNow,
                                           .heard = 2.0 + static_cast<double>(i),
                                           .last_status = 200});
    snapshot.traffic.activities.push_back(
        {.kind = "state", .robot = name, .last_forwarded = kNow, .heard = 1.0, .last_status = 200});
  }
  return snapshot;
}

}  // namespace adit::alarms
