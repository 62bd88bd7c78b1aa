// The alarms: found, shown, and acknowledged.
#include "alarms/conditions.hpp"
#include "gateway/gateway.hpp"

namespace adit::gateway {

std::vector<alarms::Alarm> Gateway::alarms() const {
  const alarms::Facts found = facts(flow_.activities());
  return board_.shown(alarms::conditions_of(found), found.now);
}

double Gateway::look_for_alarms() {
  const auto activities = flow_.activities();
  lookout_.look(flow_, settings_, activities, loop_.stamp_now(), loop_.wall_now());
  const alarms::Facts found = facts(activities);
  const std::vector<alarms::Condition> conditions = alarms::conditions_of(found);
  board_.take(conditions, found.now);
  // What goes because the service does is no alarm that went.
  if (!flow_.is_ending()) acknowledged_.keep(board_.acknowledged());
  std::vector<std::string> headlines;
  for (const alarms::Condition& each : conditions) {
    if (each.severity != alarms::Severity::Wait) headlines.push_back(each.headline.now());
  }
  flow_.archive().needs_attention(headlines, found.now);
  return found.now;
}

std::expected<void, std::string> Gateway::acknowledge(const std::string& id) {
  auto done = board_.acknowledge(id, look_for_alarms());
  acknowledged_.keep(board_.acknowledged());
  show_lights();
  return done;
}

}  // namespace adit::gateway
