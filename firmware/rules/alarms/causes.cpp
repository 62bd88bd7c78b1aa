#include <algorithm>
#include <string_view>

#include "alarms/conditions.hpp"

namespace adit::alarms {
namespace {

bool is(const Condition& condition, std::string_view name) {
  return std::string_view(condition.id).substr(0, condition.id.find(':')) == name;
}

bool is_command_post(const Condition& condition) {
  return condition.id.starts_with("command_post_") && !is(condition, "command_post_throttling");
}

bool is_link_loss(const Condition& condition) {
  return condition.id == "cable_out:command_post" || condition.id == "cables_exchanged" ||
         condition.id == "no_address";
}

/// Whether the condition stops all traffic to the endpoint.
bool stops(const Condition& condition, std::string_view endpoint) {
  if (is_link_loss(condition)) return true;
  const bool down = is_command_post(condition) || is(condition, "no_token");
  return down && (condition.subject.empty() || condition.subject == endpoint);
}

bool is_robots_silence(const Condition& condition) {
  return is(condition, "robot_silent") || is(condition, "robots_silent");
}

bool is_of_maps(const Condition& condition) {
  return is(condition, "map_behind") || is(condition, "maps_behind") || condition.id.starts_with("queue_");
}

/// Whether the condition concerns the spare after a takeover.
bool is_for_the_spare(const Condition& condition) {
  return is_command_post(condition) || is(condition, "command_post_throttling") ||
         is_robots_silence(condition) || is_of_maps(condition) || is(condition, "clients_refused") ||
         condition.id.starts_with("report_");
}

bool explains(const Condition& cause, const Condition& other) {
  if (cause.id == "standby") return is_for_the_spare(other);
  if (is_link_loss(cause) && (is_command_post(other) || is(other, "command_post_throttling"))) return true;
  if (stops(cause, "mapping") && (is_of_maps(other) || is_robots_silence(other))) return true;
  if (stops(cause, "scoring") && is(other, "report_in_doubt") && other.severity == Severity::Wait)
    return true;
  return cause.id == "cable_out:team" && is_robots_silence(other);
}

/// Hides consequences of larger causes and counts them there. Order: cable, endpoints, maps, robots.
void hide_consequences(Conditions& found) {
  // Larger causes come first, so a condition is counted at its largest cause.
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::uint64_t hidden = 0;
    for (std::size_t j = found.size(); j-- > 0;) {
      if (j == i || !explains(found[i], found[j])) continue;
      hidden += std::max<std::uint64_t>(found[j].hides, 1);
      found.erase(found.begin() + static_cast<std::ptrdiff_t>(j));
      if (j < i) --i;
    }
    found[i].hides += hidden;
  }
}

}  // namespace

std::vector<Condition> conditions_of(const facts::Snapshot& snapshot) {
  Conditions found;
  find_network_troubles(snapshot.network, snapshot.traffic, found);
  find_command_post_troubles(snapshot.traffic, found);
  find_report_troubles(snapshot.reports, found);
  find_robot_troubles(snapshot.traffic, snapshot.clients, found);
  find_box_troubles(snapshot.box, found);
  hide_consequences(found);
  return found;
}

}  // namespace adit::alarms
