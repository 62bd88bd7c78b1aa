#pragma once

#include <vector>

#include "alarms/endpoint_watch.hpp"
#include "alarms/habits.hpp"
#include "forward/flow.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// Facts that need observation over time: the endpoints' answers, the robots' intervals, the growth of the
/// queue. `now`: seconds of the stamp clock, which never steps.
class ObservedFacts {
 public:
  /// Call once a second. `time`: time of day.
  void look(forward::Flow& flow, const settings::Settings& settings,
            const std::vector<api::ActivityRow>& activities, double now, api::Time time);
  /// Call after the flow's start and before any answer: takes the robots from before.
  void carry_on(const forward::Flow& flow, double now);
  /// The endpoint or its token has changed.
  void forget_scoring() { scoring_.forget(); }
  void forget_mapping() { mapping_.forget(); }

  /// Scoring, then mapping.
  std::vector<alarms::Endpoint> endpoints(const forward::Flow& flow,
                                          const settings::CommandPost& command_post, double now) const;
  std::map<std::string, alarms::Robot> robots(const settings::Alarms& rules, double now) const;
  bool queue_grows(double now) const { return growth_.grows(now); }

 private:
  alarms::EndpointWatch scoring_, mapping_{true};
  alarms::Habits habits_;
  alarms::Growth growth_;
  std::map<std::string, std::uint64_t> told_;  // accepted and forwarded messages at the last save
};

}  // namespace adit::gateway
