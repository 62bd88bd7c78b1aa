#include "api/judged.hpp"

#include "alarms/standing.hpp"
#include "icd/require.hpp"

namespace adit::api {

std::vector<alarms::Stream> streams_of(const std::vector<ActivityRow>& rows, Time now) {
  const auto ago = [now](const std::optional<Time>& at) {
    return at ? std::optional(now - *at) : std::nullopt;
  };
  std::vector<alarms::Stream> streams;
  streams.reserve(rows.size());
  for (const ActivityRow& row : rows) {
    streams.push_back({.kind = row.kind,
                       .robot = row.robot,
                       .behind = ago(row.behind_since),
                       .forwarded = ago(row.last_forwarded),
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
  }
  view.verdict = alarms::verdict_of(facts);
}

}  // namespace adit::api
