#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "alarms/conditions.hpp"

namespace adit::alarms {

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

/// A run without alarms: that many robots, each with a grid and poses.
inline Facts well(std::size_t robots = 2) {
  Facts facts{.now = kNow};
  facts.endpoints = {{.name = "scoring", .address = "10.100.1.200:8000"},
                     {.name = "mapping", .address = "10.100.1.201:8000"}};
  facts.cables = {{true, "team0", true}, {false, "darpa0", true}};
  facts.queue_room = 100u << 20;
  facts.reports_left = 45;
  facts.disk.free = 1u << 30;
  facts.time_set = true;
  for (std::size_t i = 1; i <= robots; ++i) {
    const std::string name = "uav" + std::to_string(i);
    facts.robots[name] = {.gap = 1, .quiet = 1};
    facts.streams.push_back(
        {.kind = "grid", .robot = name, .forwarded = 2.0 + static_cast<double>(i), .last_status = 200});
    facts.streams.push_back({.kind = "state", .robot = name, .forwarded = 1.0, .last_status = 200});
  }
  return facts;
}

}  // namespace adit::alarms
