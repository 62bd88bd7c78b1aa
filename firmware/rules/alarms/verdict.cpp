#include "alarms/verdict.hpp"

#include <algorithm>
#include <map>
#include <ranges>
#include <set>

#include "alarms/alarm.hpp"
#include "alarms/arrival.hpp"
#include "icd/natural_order.hpp"
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
const EndpointRow* stopped_endpoint(const Traffic& traffic) {
  const EndpointRow* const endpoint = mapping(traffic);
  return endpoint != nullptr && endpoint->fault < EndpointFault::Throttling ? endpoint : nullptr;
}

/// Whether the row's last result may date from when the endpoint was stopped.
bool is_catching_up(const ActivityRow& row, const Traffic& traffic) {
  const EndpointRow* const endpoint = mapping(traffic);
  return endpoint != nullptr && endpoint->well_for && *endpoint->well_for < kLateAfter + traffic.turn &&
         (row.age || !row.last_sentence.empty() || icd::concerns_all_messages(row.last_status));
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
std::vector<std::string> unheard_robots(const Traffic& traffic) {
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

/// std::nullopt only if both are.
std::optional<double> least(std::optional<double> one, std::optional<double> other) {
  return one && other ? std::min(one, other) : std::max(one, other);
}

struct Maps {
  Level level = Level::Quiet;
  bool is_silent = false, is_first = true;     // is_first: none was sent so far, and none is late
  std::optional<double> age = {}, heard = {};  // of the oldest undelivered map; of the newest map
};

/// By robot; "": the merged map.
using AllMaps = std::map<std::string, Maps, icd::NaturalOrder>;

AllMaps maps_of(const Traffic& traffic) {
  AllMaps all;
  for (const ActivityRow& row : traffic.activities) {
    if (!row.is_map()) continue;
    Maps& maps = all[row.robot];
    const bool is_first = row.arrival == Arrival::NotYet;
    maps.level = std::max(maps.level, is_first ? Level::Good : row.level);
    maps.is_first &= is_first;
    maps.is_silent |= row.arrival == Arrival::Silent;
    maps.age = std::max(maps.age, row.age);
    maps.heard = least(maps.heard, row.heard);
  }
  for (const std::string& name : unheard_robots(traffic))
    all[name] = {.level = Level::Bad, .is_silent = true};
  return all;
}

/// How the maps of several robots arrive.
struct Group {
  std::vector<std::string> names = {};
  std::optional<double> oldest = {};

  void add(const std::string& name, const Maps& maps) {
    names.push_back(name);
    oldest = std::max(oldest, maps.age);
  }
  bool empty() const { return names.empty(); }
  bool has_merged() const { return !empty() && names.front().empty(); }  // the first by name
  std::size_t robots() const { return names.size() - (has_merged() ? 1 : 0); }
};

struct Groups {
  Group failing, silent, late, first, arriving, quiet;
};

Groups groups_of(const AllMaps& all) {
  Groups groups;
  for (const auto& [name, maps] : all) {
    Group& group = maps.level == Level::Bad    ? (maps.is_silent ? groups.silent : groups.failing)
                   : maps.level == Level::Wait ? groups.late
                   : maps.level == Level::Good ? (maps.is_first ? groups.first : groups.arriving)
                                               : groups.quiet;
    group.add(name, maps);
  }
  return groups;
}

/// Robots that send other messages or are registered, but of which no map came.
std::vector<std::string> robots_lacking_map(const Traffic& traffic, const AllMaps& all) {
  std::set<std::string, icd::NaturalOrder> names(traffic.registered.begin(), traffic.registered.end());
  for (const StandingRow& robot : traffic.standings) names.insert(robot.name);
  std::erase_if(names, [&all](const std::string& name) { return all.contains(name); });
  return {names.begin(), names.end()};
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

/// Appends a part of a sentence, unless `names` is empty.
void append(std::string& why, std::string_view before, const std::vector<std::string>& names,
            std::string_view after) {
  if (!names.empty()) why += sentence(why.empty() ? "" : "; ", before, names_of(names), after);
}

/// "20 robots and the merged map, "
std::string describe_arriving(const Group& arriving) {
  const std::size_t robots = arriving.robots();
  std::string who;
  if (robots > 0) who = sentence(robots, robots == 1 ? " robot" : " robots");
  if (arriving.has_merged()) who += robots > 0 ? " and the merged map" : "the merged map";
  return who + ", ";
}

/// "oldest 22 s"
std::string age_of(const Group& arriving) {
  if (arriving.oldest.value_or(0) < 1) return "up to date";
  return sentence(arriving.names.size() == 1 ? "" : "oldest ", age_text(*arriving.oldest));
}

/// Some maps fail, or their robots are silent. `robots`: how many there are. `missing`: those without a map.
Verdict partly(const Groups& groups, std::size_t robots, const std::vector<std::string>& missing) {
  std::string why;
  append(why, "not ", groups.failing.names, "");
  append(why, "", groups.silent.names, " silent");
  append(why, "no map yet from ", groups.first.names, "");
  append(why, "no map from ", missing, "");
  append(why, "", groups.quiet.names, " quiet");
  Group other = groups.arriving;
  other.names.insert(other.names.end(), groups.late.names.begin(), groups.late.names.end());
  other.oldest = std::max(other.oldest, groups.late.oldest);
  std::ranges::sort(other.names);
  if (other.empty()) return {Level::Bad, "No map arrives", std::move(why)};
  if (other.robots() == robots)
    return {Level::Wait, "The merged map does not arrive", describe_arriving(other) + age_of(other)};
  if (other.oldest)
    why += sentence(other.names.size() == 1 ? "; the other " : "; oldest other ", age_text(*other.oldest));
  if (other.robots() == 0) return {Level::Wait, "Only the merged map arrives", std::move(why)};
  return {Level::Wait, sentence(other.robots(), " of ", robots, " arrive"), std::move(why)};
}

/// `rows`: of the robot, in the order of kinds.
StandingRow standing_row(const std::string& name, const std::vector<const ActivityRow*>& rows) {
  const bool has_delivered = std::ranges::any_of(
      rows, [](const ActivityRow* row) { return row->is_map() && row->arrival != Arrival::NotYet; });
  const auto weight = [has_delivered](const ActivityRow* row) {  // the first map of a second kind is not late
    return has_delivered && row->arrival == Arrival::NotYet ? -1 : static_cast<int>(row->level);
  };
  const ActivityRow& worst = **std::ranges::max_element(rows, {}, weight);
  StandingRow standing{.name = name, .level = worst.level, .word = worst.word};
  standing.has_map = std::ranges::any_of(rows, &ActivityRow::is_map);
  for (const ActivityRow* row : rows) {
    standing.silent |= row->arrival == Arrival::Silent;
    standing.heard = least(standing.heard, row->heard);
    if (row->is_map() || !standing.has_map) standing.age = std::max(standing.age, row->age);
  }
  return standing;
}

void add_standings(Traffic& traffic) {
  std::map<std::string, std::vector<const ActivityRow*>, icd::NaturalOrder> all;
  for (const ActivityRow& row : traffic.activities) all[row.robot].push_back(&row);
  all.erase("");
  for (const auto& [name, rows] : all) traffic.standings.push_back(standing_row(name, rows));
  if (stopped_endpoint(traffic) != nullptr) return;
  for (const std::string& name : unheard_robots(traffic)) {
    traffic.standings.push_back({.name = name,
                                 .level = Level::Bad,
                                 .word = "silent",
                                 .silent = true,
                                 .heard = traffic.habits.at(name).quiet});
  }
  std::ranges::sort(traffic.standings, icd::NaturalOrder(), &StandingRow::name);
}

/// When the pose at the Command Post was posted. The latest one may be queued or rejected.
facts::Time posted_at(const ActivityRow& row) {
  return std::min(*row.last_forwarded, row.last_accepted.value_or(*row.last_forwarded));
}

/// Words for an endpoint, by alarm name.
constexpr std::pair<std::string_view, std::string_view> kFaultWords[] = {
    {"no_token", "no token"},
    {"cable_out", "cable out"},
    {"cables_exchanged", "cables exchanged"},
    {"no_address", "no address"},
    {"command_post_unreachable", "unreachable"},
    {"command_post_foreign", "wrong host"},
    {"command_post_refusing", "rejected"},
    {"command_post_silent", "silent"},
    {"command_post_failing", "failing"},
    {"command_post_throttling", "slow down"}};

constexpr double kSlowAfter = 3;  // seconds of a request without progress

/// Trouble without an alarm may pass: some servers close the connection after each answer.
void add_word(EndpointRow& row, const std::vector<Alarm>& alarms) {
  const bool is_slow = row.waits > kSlowAfter;
  const bool is_well = !is_slow && row.trouble.empty() && (row.connected || row.last_status > 0);
  row.level = is_well ? Level::Good : Level::Wait;
  row.word = is_well                  ? "connected"
             : is_slow                ? "no answer yet"
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

std::optional<double> queue_age(const ActivityRow& row, const Traffic& traffic) {
  const EndpointRow* const endpoint = mapping(traffic);
  if (!row.age || endpoint == nullptr || !endpoint->well_for) return row.age;
  return std::min(*row.age, *endpoint->well_for);
}

Standing standing_of(const ActivityRow& row, const Traffic& traffic) {
  const bool is_stopped = stopped_endpoint(traffic) != nullptr;
  const Arrival arrival = arrival_of(row, traffic.turn, !is_stopped && is_silent(row.robot, traffic));
  const Level level = level_of(arrival);
  const bool is_kept_back = is_stopped && (row.age || !row.last_sentence.empty() || level == Level::Bad);
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
    const bool is_late = arrival == Arrival::Late && row.age;
    row.word = is_late ? age_text(*row.age) + " behind" : std::string(name_of(arrival));
  }
  for (facts::RobotRow& robot : traffic.robots) {
    const auto its = std::ranges::find_if(traffic.activities, [&robot](const ActivityRow& row) {
      return row.kind == "state" && row.robot == robot.name;
    });
    if (its != traffic.activities.end() && its->last_forwarded) robot.at = posted_at(*its);
    if (robot.at) robot.age = facts::seconds_since(*robot.at, traffic.now);
  }
  for (EndpointRow& row : traffic.endpoints) add_word(row, alarms);
  add_standings(traffic);
}

constexpr codec::Row Verdict::kRow = codec::complete<Verdict>({"Verdict", kVerdict, "Is my map arriving?"});

Verdict verdict_of(const Traffic& traffic) {
  const auto all = maps_of(traffic);
  if (const EndpointRow* endpoint = stopped_endpoint(traffic); endpoint != nullptr && !all.empty()) {
    const std::string why = endpoint->fault == EndpointFault::NoToken
                                ? "the mapping token is missing"
                                : "for " + clock_text(traffic.now - endpoint->since);
    return {Level::Bad, "No map arrives", why + "; the box keeps all maps"};
  }
  if (all.empty()) return {Level::Quiet, "No map yet", "no robot has sent one since the box started"};
  const Groups groups = groups_of(all);
  const auto missing = robots_lacking_map(traffic, all);
  const std::size_t robots = all.size() + missing.size() - all.count("");
  if (!groups.failing.empty() || !groups.silent.empty()) return partly(groups, robots, missing);
  if (!groups.late.empty()) {
    std::string why = names_of(groups.late.names);
    if (groups.late.oldest) why += ", " + age_text(*groups.late.oldest) + " behind";
    append(why, "no map yet from ", groups.first.names, "");
    append(why, "no map from ", missing, "");
    return {Level::Wait, "Maps are late", std::move(why)};
  }
  if (groups.first.names.size() == all.size()) return {Level::Wait, "No map yet", "the first one is queued"};
  const std::size_t there = groups.arriving.robots() + groups.quiet.robots();
  const bool is_merged_alone = there == 0,
             are_all = groups.first.empty() && missing.empty() && !is_merged_alone;
  const bool are_quiet = groups.arriving.empty();
  std::string why;
  if (are_quiet) {
    std::optional<double> heard;
    for (const std::string& name : groups.quiet.names) heard = least(heard, all.at(name).heard);
    why = "no new map for " + age_text(heard.value_or(0));
  } else {
    why = (are_all ? describe_arriving(groups.arriving) : "") + age_of(groups.arriving);
    append(why, "", groups.quiet.names, " quiet");
  }
  append(why, "no map yet from ", groups.first.names, "");
  append(why, "no map from ", missing, "");
  const std::string which = are_all           ? "Every map"
                            : is_merged_alone ? "The merged map"
                                              : sentence(there, " of ", robots);
  const std::string_view verb = are_quiet ? " arrived" : are_all || is_merged_alone ? " arrives" : " arrive";
  return {are_quiet ? Level::Quiet : Level::Good, which + std::string(verb), std::move(why)};
}

}  // namespace adit::alarms
