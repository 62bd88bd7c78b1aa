#include "api/verdicts.hpp"

#include <algorithm>
#include <map>
#include <ranges>

#include "alarms/alarm.hpp"
#include "alarms/verdict.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::api {

double seconds_since(Time at, Time now) {
  return std::max(0.0, now - at);
}

/// The latest accepted update may be rejected or unsendable, so the earlier of both times counts.
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

namespace {

/// `rows`: of the robot, in the order of kinds.
StandingRow standing_of(const std::string& name, std::vector<const ActivityRow*> rows) {
  const auto is_pose = [](const ActivityRow* row) { return row->kind == "state"; };
  const auto is_quiet = [](const ActivityRow* row) { return row->level == alarms::Level::Quiet; };
  const ActivityRow& worst = **std::ranges::max_element(rows, {}, &ActivityRow::level);
  const bool silent = std::ranges::count(rows, alarms::Arrival::Silent, &ActivityRow::arrival) > 0;
  const bool has_map = !std::ranges::all_of(rows, is_pose);
  if (has_map) std::erase_if(rows, is_pose);
  const bool are_quiet = std::ranges::all_of(rows, is_quiet);
  if (!are_quiet) std::erase_if(rows, is_quiet);
  const auto [newest, oldest] = std::ranges::minmax(rows, {}, &ActivityRow::age);
  const auto age = newest->age && !are_quiet ? oldest->age : newest->age;
  return {name, worst.level, worst.word, silent, has_map, age};
}

void add_robots(RunView& view, const alarms::Facts& facts) {
  std::map<std::string, std::vector<const ActivityRow*>> all;
  for (const ActivityRow& row : view.activities) all[row.robot].push_back(&row);
  all.erase("");
  for (const auto& [name, rows] : all) view.standings.push_back(standing_of(name, rows));
  if (alarms::stopped(facts) != nullptr) return;
  for (const std::string& name : alarms::unheard(facts)) {
    const auto pose = std::ranges::find(view.robots, name, &RobotRow::name);
    const auto age = pose == view.robots.end() ? std::nullopt : pose->age;
    view.standings.push_back({name, alarms::Level::Bad, "silent", true, false, age});
  }
  std::ranges::sort(view.standings, {}, &StandingRow::name);
}

/// Words for an endpoint, by alarm name.
constexpr std::pair<std::string_view, std::string_view> kTroubles[] = {
    {"no_token", "no token"},
    {"cable_out", "cable out"},
    {"cables_exchanged", "cables exchanged"},
    {"no_address", "no address"},
    {"command_post_unreachable", "unreachable"},
    {"command_post_foreign", "wrong host"},
    {"command_post_refusing", "refused"},
    {"command_post_silent", "silent"},
    {"command_post_failing", "failing"},
    {"command_post_throttling", "slow down"}};

/// Trouble without an alarm may pass: some servers close the connection after each answer.
void add_endpoint(EndpointRow& row, const std::vector<alarms::Alarm>& alarms) {
  const bool is_well = row.trouble.empty() && (row.connected || row.last_status > 0);
  row.level = is_well ? alarms::Level::Good : alarms::Level::Wait;
  row.word = is_well                  ? "connected"
             : row.last_status >= 400 ? icd::sentence("status ", row.last_status)
             : row.connected          ? "retrying"
                                      : "not connected";
  for (const alarms::Alarm& alarm : alarms | std::views::reverse) {
    if (!alarm.subject.empty() && alarm.subject != row.name && alarm.subject != "command_post") continue;
    for (const auto& [name, word] : kTroubles) {
      if (alarm.id.substr(0, alarm.id.find(':')) != name) continue;
      row.level = alarm.severity == alarms::Severity::Bad ? alarms::Level::Bad : alarms::Level::Wait;
      row.word = word;
    }
  }
}

}  // namespace

void add_verdicts(RunView& view, const alarms::Facts& facts) {
  icd::require(facts.streams.size() == view.activities.size());
  for (std::size_t i = 0; i < view.activities.size(); ++i) {
    ActivityRow& row = view.activities[i];
    const auto [arrival, level] = alarms::standing_of(facts.streams[i], facts);
    row.arrival = arrival;
    row.level = level;
    row.behind = facts.streams[i].behind;
    row.age = facts.streams[i].forwarded;
    const bool is_late = arrival == alarms::Arrival::Late && row.behind;
    row.word = is_late ? alarms::age_text(*row.behind) + " behind" : std::string(name_of(arrival));
  }
  for (RobotRow& robot : view.robots) {
    const auto its = std::ranges::find_if(view.activities, [&robot](const ActivityRow& row) {
      return row.kind == "state" && row.robot == robot.name;
    });
    if (its != view.activities.end() && its->age) robot.at = facts.now - *its->age;
    if (robot.at) robot.age = seconds_since(*robot.at, facts.now);
  }
  for (EndpointRow& row : view.endpoints) add_endpoint(row, view.alarms);
  add_robots(view, facts);
  view.verdict = alarms::verdict_of(facts);
}

}  // namespace adit::api
