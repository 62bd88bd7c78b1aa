#include "api/judged.hpp"

#include <algorithm>

#include "alarms/standing.hpp"
#include "icd/require.hpp"

namespace adit::api {

double seconds_since(Time at, Time now) {
  return std::max(0.0, now - at);
}

/// A rejected update, or one that cannot be sent, was accepted and not delivered.
std::optional<double> age_of(const ActivityRow& row, Time now) {
  if (!row.last_forwarded) return std::nullopt;
  return seconds_since(std::min(*row.last_forwarded, row.last_accepted.value_or(*row.last_forwarded)), now);
}

std::vector<alarms::Stream> streams_of(const std::vector<ActivityRow>& rows, Time now) {
  const auto ago = [now](const std::optional<Time>& at) {
    return at ? std::optional(seconds_since(*at, now)) : std::nullopt;
  };
  std::vector<alarms::Stream> streams;
  streams.reserve(rows.size());
  for (const ActivityRow& row : rows) {
    streams.push_back({.kind = row.kind,
                       .robot = row.robot,
                       .behind = ago(row.behind_since),
                       .forwarded = age_of(row, now),
                       .no_room = ago(row.last_no_room),
                       .last_status = row.last_status,
                       .failed = !row.last_sentence.empty()});
  }
  return streams;
}

void judge(RunView& view, const alarms::Facts& facts) {
  icd::require(facts.streams.size() == view.activities.size());
  for (std::size_t i = 0; i < view.activities.size(); ++i) {
    ActivityRow& row = view.activities[i];
    const auto [arrival, level] = alarms::standing_of(facts.streams[i], facts);
    row.arrival = arrival;
    row.level = level;
    row.behind = facts.streams[i].behind;
    row.age = facts.streams[i].forwarded;
  }
  for (RobotRow& robot : view.robots) {
    const auto its = std::ranges::find_if(view.activities, [&robot](const ActivityRow& row) {
      return row.kind == "state" && row.robot == robot.name;
    });
    if (its != view.activities.end() && its->age) robot.at = facts.now - *its->age;
    if (robot.at) robot.age = seconds_since(*robot.at, facts.now);
  }
  view.verdict = alarms::verdict_of(facts);
}

}  // namespace adit::api
