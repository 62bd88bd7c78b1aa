#include "gateway/lookout.hpp"

#include <chrono>
#include <utility>

namespace adit::gateway {
namespace {

alarms::Seen seen(const forward::Channel& channel) {
  return {.connected = channel.connected(),
          .busy = channel.busy(),
          .ended = channel.ended(),
          .throttled = channel.throttled(),
          .sent = channel.bytes_sent(),
          .status = channel.last_status(),
          .foreign = channel.is_foreign(),
          .said = channel.trouble()};
}

alarms::Endpoint named(const char* name, const settings::Address& address, const forward::Channel& channel,
                       alarms::Endpoint endpoint) {
  if (!channel.has_token()) endpoint = {.trouble = alarms::PostTrouble::NoToken};
  endpoint.name = name;
  endpoint.address = forward::address_text(address);
  return endpoint;
}

}  // namespace

void Lookout::look(const forward::Flow& flow, const settings::Settings& settings,
                   const std::vector<api::ActivityRow>& activities, double now, api::Time time) {
  scoring_.look({seen(flow.scoring().channel())}, now);
  mapping_.look({seen(flow.maps().channel()), seen(flow.telemetry().channel())}, now);
  const std::int64_t run = flow.reports().run().number;
  const std::int64_t before = std::exchange(run_, run);
  if (before != run) habits_.forget();
  is_first_run_ = is_first_run_ && (before == 0 || before == run);
  std::map<std::string, std::uint64_t> counts;
  for (const api::ActivityRow& row : activities) counts[row.robot] += row.accepted;
  for (const auto& [robot, count] : counts) habits_.heard(robot, count, now);
  for (const auto& [robot, at] : flow.as_forwarded().before()) {
    if (is_first_run_ && time - at < alarms::Habits::Rules{}.away) habits_.expect(robot, now);
  }
  growth_.look(flow.maps().queued_bytes(), settings.queues.map_bytes, now);
}

std::vector<alarms::Endpoint> Lookout::endpoints(const forward::Flow& flow,
                                                 const settings::CommandPost& command_post,
                                                 double now) const {
  return {named("scoring", command_post.scoring, flow.scoring().channel(), scoring_.endpoint(now)),
          named("mapping", command_post.mapping, flow.maps().channel(), mapping_.endpoint(now))};
}

std::map<std::string, alarms::Robot> Lookout::robots(const settings::Alarms& rules, double now) const {
  const double least = std::chrono::duration<double>(rules.silent_for).count();
  return habits_.robots({.least = least, .times = rules.silent_times}, now);
}

}  // namespace adit::gateway
