#include "alarms/verdict.hpp"

#include <algorithm>
#include <map>
#include <ranges>

#include "alarms/alarm.hpp"
#include "alarms/arrival.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"

namespace adit::alarms {
namespace {

using facts::ActivityRow;
using facts::Arrival;
using facts::EndpointFault;
using facts::EndpointRow;
using facts::Level;
using facts::StandingRow;
using facts::Traffic;
using icd::sentence;

const EndpointRow* mapping(const Traffic& traffic) {
  const auto found = std::ranges::find(traffic.endpoints, "mapping", &EndpointRow::name);
  return found == traffic.endpoints.end() ? nullptr : &*found;
}

/// The mapping endpoint if it accepts no messages at all, or null.
const EndpointRow* stopped(const Traffic& traffic) {
  const EndpointRow* const endpoint = mapping(traffic);
  return endpoint != nullptr && endpoint->fault < EndpointFault::Throttling ? endpoint : nullptr;
}

/// Whether the row's last result may date from when the endpoint was stopped.
bool is_catching_up(const ActivityRow& row, const Traffic& traffic) {
  const EndpointRow* const endpoint = mapping(traffic);
  return endpoint != nullptr && endpoint->well_for && *endpoint->well_for < kLateAfter + traffic.turn &&
         (row.behind || !row.last_sentence.empty() || icd::concerns_all_messages(row.last_status));
}

/// Whether the robot has stopped sending by its own fault.
bool is_silent(const std::string& robot, const Traffic& traffic) {
  const auto found = traffic.habits.find(robot);
  const bool is_cut_off = std::ranges::any_of(traffic.links, [](const facts::LinkRow& link) {
    return link.is_team() && !link.carrier.value_or(false);
  });
  return found != traffic.habits.end() && found->second.silent && !is_cut_off;
}

/// Names of the silent robots that have sent no message since the service started.
std::vector<std::string> unheard(const Traffic& traffic) {
  std::vector<std::string> names;
  for (const auto& [name, habit] : traffic.habits) {
    const bool is_heard = std::ranges::count(traffic.activities, name, &ActivityRow::robot) > 0;
    if (!is_heard && is_silent(name, traffic)) names.push_back(name);
  }
  return names;
}

constexpr codec::Member kVerdict[] = {
    codec::member<&Verdict::level>("level").one_of(facts::kLevelWords),
    codec::member<&Verdict::what>("what", "whether every map arrives, in few words"),
    codec::member<&Verdict::why>("why", "which do not, and how old the others are; may be empty"),
};

/// The maps of one robot.
struct Maps {
  Level level = Level::Quiet;
  // Seconds: age or delay of the oldest map that is not quiet, and age of the newest map.
  std::optional<double> oldest = {}, newest = {};
};

std::map<std::string, Maps> maps_of(const Traffic& traffic) {
  std::map<std::string, Maps> all;
  for (const ActivityRow& row : traffic.activities) {
    if (!row.is_map()) continue;
    Maps& maps = all[row.robot];
    maps.level = std::max(maps.level, row.level);
    if (!row.age) continue;
    maps.newest = std::min(*row.age, maps.newest.value_or(*row.age));
    if (row.level == Level::Quiet) continue;
    const double age = std::min(*row.age, row.behind.value_or(*row.age));
    maps.oldest = std::max(age, maps.oldest.value_or(0));
  }
  for (const std::string& name : unheard(traffic)) all[name].level = Level::Bad;
  return all;
}

std::string names_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNames = 3;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMostNames; ++i) {
    text += i == 0 ? "" : ", ";
    text += names[i].empty() ? "the merged map" : names[i];
  }
  return names.size() > kMostNames ? sentence(text, " and ", names.size() - kMostNames, " more") : text;
}

/// "20 robots and the merged map, oldest 22 s".
std::string all_arrive(const std::map<std::string, Maps>& all, double oldest) {
  const bool is_merged = all.contains("");
  const std::size_t robots = all.size() - (is_merged ? 1 : 0);
  std::string who;
  if (robots > 0) who = sentence(robots, robots == 1 ? " robot" : " robots");
  if (is_merged) who += robots > 0 ? " and the merged map" : "the merged map";
  return sentence(who, all.size() == 1 ? ", " : ", oldest ", age_text(oldest));
}

std::vector<std::string> names_at(const std::map<std::string, Maps>& all, Level level) {
  std::vector<std::string> names;
  for (const auto& [name, maps] : all) {
    if (maps.level == level) names.push_back(name);
  }
  return names;
}

Verdict partly(const std::map<std::string, Maps>& all, std::optional<double> oldest) {
  const std::vector<std::string> lacking = names_at(all, Level::Bad);
  const std::size_t arrive = all.size() - lacking.size();
  std::string why = "not " + names_of(lacking);
  if (arrive == 0) return {Level::Bad, "No map arrives", std::move(why)};
  if (oldest) why += sentence(arrive == 1 ? "; the other " : "; oldest other ", age_text(*oldest));
  return {Level::Wait, sentence(arrive, " of ", all.size(), " arrive"), std::move(why)};
}

/// `rows`: of the robot, in the order of kinds.
StandingRow standing_row(const std::string& name, std::vector<const ActivityRow*> rows) {
  const auto is_pose = [](const ActivityRow* row) { return row->kind == "state"; };
  const auto is_quiet = [](const ActivityRow* row) { return row->level == Level::Quiet; };
  const ActivityRow& worst = **std::ranges::max_element(rows, {}, &ActivityRow::level);
  const bool silent = std::ranges::count(rows, Arrival::Silent, &ActivityRow::arrival) > 0;
  const bool has_map = !std::ranges::all_of(rows, is_pose);
  if (has_map) std::erase_if(rows, is_pose);
  const bool are_quiet = std::ranges::all_of(rows, is_quiet);
  if (!are_quiet) std::erase_if(rows, is_quiet);
  const auto [newest, oldest] = std::ranges::minmax(rows, {}, &ActivityRow::age);
  const auto age = newest->age && !are_quiet ? oldest->age : newest->age;
  return {name, worst.level, worst.word, silent, has_map, age};
}

void add_standings(Traffic& traffic) {
  std::map<std::string, std::vector<const ActivityRow*>> all;
  for (const ActivityRow& row : traffic.activities) all[row.robot].push_back(&row);
  all.erase("");
  for (const auto& [name, rows] : all) traffic.standings.push_back(standing_row(name, rows));
  if (stopped(traffic) != nullptr) return;
  for (const std::string& name : unheard(traffic)) {
    const auto pose = std::ranges::find(traffic.robots, name, &facts::RobotRow::name);
    const auto age = pose == traffic.robots.end() ? std::nullopt : pose->age;
    traffic.standings.push_back({name, Level::Bad, "silent", true, false, age});
  }
  std::ranges::sort(traffic.standings, {}, &StandingRow::name);
}

/// Words for an endpoint, by alarm name.
constexpr std::pair<std::string_view, std::string_view> kFaultWords[] = {
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
void add_word(EndpointRow& row, const std::vector<Alarm>& alarms) {
  const bool is_well = row.trouble.empty() && (row.connected || row.last_status > 0);
  row.level = is_well ? Level::Good : Level::Wait;
  row.word = is_well                  ? "connected"
             : row.last_status >= 400 ? sentence("status ", row.last_status)
             : row.connected          ? "retrying"
                                      : "not connected";
  for (const Alarm& alarm : alarms | std::views::reverse) {
    if (!alarm.subject.empty() && alarm.subject != row.name && alarm.subject != "command_post") continue;
    for (const auto& [name, word] : kFaultWords) {
      if (alarm.id.substr(0, alarm.id.find(':')) != name) continue;
      row.level = alarm.severity == Severity::Bad ? Level::Bad : Level::Wait;
      row.word = word;
    }
  }
}

}  // namespace

std::optional<double> waited(const ActivityRow& row, const Traffic& traffic) {
  const EndpointRow* const endpoint = mapping(traffic);
  if (!row.behind || endpoint == nullptr || !endpoint->well_for) return row.behind;
  return std::min(*row.behind, *endpoint->well_for);
}

Standing standing_of(const ActivityRow& row, const Traffic& traffic) {
  const bool is_stopped = stopped(traffic) != nullptr;
  const Arrival arrival = arrival_of(row, traffic.turn, !is_stopped && is_silent(row.robot, traffic));
  const Level level = level_of(arrival);
  const bool is_kept_back = is_stopped && (row.behind || !row.last_sentence.empty() || level == Level::Bad);
  if (is_kept_back) return {Arrival::NotArriving, Level::Quiet};
  const bool is_of_before = arrival == Arrival::NotArriving || arrival == Arrival::Failing ||
                            (arrival == Arrival::Refused && icd::concerns_all_messages(row.last_status));
  if (is_of_before && is_catching_up(row, traffic)) return {Arrival::Late, Level::Wait};
  return {arrival, level};
}

void add_words(Traffic& traffic, const std::vector<Alarm>& alarms) {
  for (ActivityRow& row : traffic.activities) {
    const auto [arrival, level] = standing_of(row, traffic);
    row.arrival = arrival;
    row.level = level;
    const bool is_late = arrival == Arrival::Late && row.behind;
    row.word = is_late ? age_text(*row.behind) + " behind" : std::string(name_of(arrival));
  }
  for (facts::RobotRow& robot : traffic.robots) {
    const auto its = std::ranges::find_if(traffic.activities, [&robot](const ActivityRow& row) {
      return row.kind == "state" && row.robot == robot.name;
    });
    if (its != traffic.activities.end() && its->age) robot.at = traffic.now - *its->age;
    if (robot.at) robot.age = facts::seconds_since(*robot.at, traffic.now);
  }
  for (EndpointRow& row : traffic.endpoints) add_word(row, alarms);
  add_standings(traffic);
}

constexpr codec::Row Verdict::kRow = {"Verdict", kVerdict, "Is my map arriving?"};

Verdict verdict_of(const Traffic& traffic) {
  const auto all = maps_of(traffic);
  if (const EndpointRow* endpoint = stopped(traffic); endpoint != nullptr && !all.empty()) {
    const std::string why = endpoint->fault == EndpointFault::NoToken
                                ? "the mapping token is missing"
                                : "for " + clock_text(traffic.now - endpoint->since);
    return {Level::Bad, "No map arrives", why + "; the box keeps all maps"};
  }
  if (all.empty()) return {Level::Quiet, "No map yet", "no robot has sent one since the box started"};
  Level worst = Level::Quiet;
  std::optional<double> oldest, newest;
  for (const auto& [name, maps] : all) {
    worst = std::max(worst, maps.level);
    if (maps.level == Level::Bad || !maps.newest) continue;
    oldest = std::max(maps.oldest.value_or(0), oldest.value_or(0));
    newest = std::min(*maps.newest, newest.value_or(*maps.newest));
  }
  if (worst == Level::Bad) return partly(all, oldest);
  if (worst == Level::Wait) return {Level::Wait, "Maps are late", names_of(names_at(all, Level::Wait))};
  if (worst == Level::Quiet)
    return {Level::Quiet, "Every map arrived", "no new map for " + age_text(newest.value_or(0))};
  return {Level::Good, "Every map arrives", all_arrive(all, oldest.value_or(0))};
}

}  // namespace adit::alarms
