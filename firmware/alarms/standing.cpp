#include "alarms/standing.hpp"

#include <algorithm>

namespace adit::alarms {
namespace {

const Endpoint* mapping(const Facts& facts) {
  const auto found = std::ranges::find(facts.endpoints, "mapping", &Endpoint::name);
  return found == facts.endpoints.end() ? nullptr : &*found;
}

/// Whether the status concerns the endpoint or its token rather than the message (PostWatch).
bool is_of_endpoint(int status) {
  return status == 401 || status == 403 || status == 404 || status == 405 || status == 407;
}

/// Whether the stream's last result may date from when the endpoint was stopped.
bool is_catching_up(const Stream& stream, const Facts& facts) {
  const Endpoint* const endpoint = mapping(facts);
  return endpoint != nullptr && endpoint->well_for && *endpoint->well_for < kLateAfter + facts.turn &&
         (stream.behind || stream.failed || is_of_endpoint(stream.last_status));
}

}  // namespace

bool is_silent(const std::string& robot, const Facts& facts) {
  const auto found = facts.robots.find(robot);
  const bool is_cut_off = std::ranges::any_of(
      facts.cables, [](const Cable& cable) { return cable.is_team && !cable.carrier.value_or(false); });
  return found != facts.robots.end() && found->second.silent && !is_cut_off;
}

std::vector<std::string> unheard(const Facts& facts) {
  std::vector<std::string> names;
  for (const auto& [name, robot] : facts.robots) {
    const bool is_heard = std::ranges::count(facts.streams, name, &Stream::robot) > 0;
    if (!is_heard && is_silent(name, facts)) names.push_back(name);
  }
  return names;
}

const Endpoint* stopped(const Facts& facts) {
  const Endpoint* const endpoint = mapping(facts);
  return endpoint != nullptr && endpoint->trouble < PostTrouble::Throttling ? endpoint : nullptr;
}

std::optional<double> waited(const Stream& stream, const Facts& facts) {
  const Endpoint* const endpoint = mapping(facts);
  if (!stream.behind || endpoint == nullptr || !endpoint->well_for) return stream.behind;
  return std::min(*stream.behind, *endpoint->well_for);
}

Standing standing_of(const Stream& stream, const Facts& facts) {
  const bool is_stopped = stopped(facts) != nullptr;
  const Arrival arrival = arrival_of(stream, facts.turn, !is_stopped && is_silent(stream.robot, facts));
  const Level level = level_of(arrival);
  const bool is_kept_back = is_stopped && (stream.behind || stream.failed || level == Level::Bad);
  if (is_kept_back) return {Arrival::NotArriving, Level::Quiet};
  const bool is_of_before = arrival == Arrival::NotArriving || arrival == Arrival::Failing ||
                            (arrival == Arrival::Refused && is_of_endpoint(stream.last_status));
  if (is_of_before && is_catching_up(stream, facts)) return {Arrival::Late, Level::Wait};
  return {arrival, level};
}

}  // namespace adit::alarms
