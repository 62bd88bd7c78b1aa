// Alarms: finding, showing, acknowledging.
#include "alarms/conditions.hpp"
#include "gateway/gateway.hpp"

namespace adit::gateway {

void Gateway::look_for_alarms() {
  const auto activities = flow_.activities();
  lookout_.look(flow_, settings_, activities, loop_.stamp_now(), loop_.wall_now());
  const alarms::Facts found = facts(activities);
  conditions_ = alarms::conditions_of(found);
  looked_at_ = found.now;
  board_.take(conditions_, looked_at_);
  // At a stop conditions end that are not cleared.
  if (!flow_.is_ending()) acknowledged_.keep(board_.acknowledged());
  std::vector<std::string> headlines;
  for (const alarms::Condition& each : conditions_) {
    if (each.severity != alarms::Severity::Wait) headlines.push_back(each.headline.now());
  }
  flow_.archive().needs_attention(headlines, looked_at_);
}

std::expected<void, std::string> Gateway::acknowledge(const std::string& id) {
  look_for_alarms();
  auto done = board_.acknowledge(id, looked_at_);
  acknowledged_.keep(board_.acknowledged());
  show_lights();
  return done;
}

}  // namespace adit::gateway
