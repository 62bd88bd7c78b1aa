#pragma once

#include <vector>

#include "alarms/growth.hpp"
#include "alarms/habits.hpp"
#include "alarms/post_watch.hpp"
#include "forward/flow.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// What of the flow means something only over time: how the endpoints answer, how often each robot speaks,
/// whether what waits grows. `now` is seconds of the clock for stamps, which never steps.
class Lookout {
 public:
  /// To be told each second, with the activities of the view. `time`: of the day.
  void look(forward::Flow& flow, const settings::Settings& settings,
            const std::vector<api::ActivityRow>& activities, double now, api::Time time);
  /// Once the flow has started, before anybody is answered: what it knows of the robots from before.
  void carry_on(const forward::Flow& flow, double now);
  /// That endpoint is another place, or has another token.
  void forget_scoring() { scoring_.forget(); }
  void forget_mapping() { mapping_.forget(); }

  /// The scoring endpoint, then the mapping endpoint.
  std::vector<alarms::Endpoint> endpoints(const forward::Flow& flow,
                                          const settings::CommandPost& command_post, double now) const;
  std::map<std::string, alarms::Robot> robots(const settings::Alarms& rules, double now) const;
  bool queue_grows(double now) const { return growth_.grows(now); }

 private:
  alarms::PostWatch scoring_, mapping_;
  alarms::Habits habits_;
  alarms::Growth growth_;
  std::map<std::string, std::uint64_t> told_;  // by robot: messages accepted and forwarded, as last kept
};

}  // namespace adit::gateway
