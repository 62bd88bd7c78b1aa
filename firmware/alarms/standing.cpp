#include "alarms/standing.hpp"

#include <algorithm>

namespace adit::alarms {
namespace {

bool is_silent(const Stream& stream, const Facts& facts) {
  const auto robot = facts.robots.find(stream.robot);
  const bool is_cut_off = std::ranges::any_of(
      facts.cables, [](const Cable& cable) { return cable.is_team && !cable.carrier.value_or(false); });
  return robot != facts.robots.end() && robot->second.silent && !is_cut_off;
}

}  // namespace

const Endpoint* stopped(const Facts& facts) {
  const auto found = std::ranges::find_if(facts.endpoints, [](const Endpoint& endpoint) {
    return endpoint.name == "mapping" && endpoint.trouble < PostTrouble::Throttling;
  });
  return found == facts.endpoints.end() ? nullptr : &*found;
}

Standing standing_of(const Stream& stream, const Facts& facts) {
  const bool is_stopped = stopped(facts) != nullptr;
  const Arrival arrival = arrival_of(stream, facts.turn, !is_stopped && is_silent(stream, facts));
  const Level level = level_of(arrival);
  const bool is_kept_back = is_stopped && (stream.behind || stream.failed || level == Level::Bad);
  return is_kept_back ? Standing{Arrival::NotArriving, Level::Quiet} : Standing{arrival, level};
}

}  // namespace adit::alarms
