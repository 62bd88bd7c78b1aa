// Conditions of the robots, their maps, and the clients.
#include <algorithm>
#include <set>

#include "alarms/alarm.hpp"
#include "alarms/arrival.hpp"
#include "alarms/conditions.hpp"
#include "alarms/verdict.hpp"
#include "icd/natural_order.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"
#include "icd/text.hpp"

namespace adit::alarms {
namespace {

using facts::ActivityRow;
using facts::Traffic;
using icd::sentence;

constexpr std::size_t kMegabyte = 1'000'000;
constexpr double kNoRoomRecent = 60;  // seconds that a rejection for want of room is reported
constexpr std::size_t kNamed = 3;     // robots named in a sentence
constexpr std::size_t kMany = 4;      // robots that share one condition

Action show(const std::string& robot) {
  return {"Show robot", "/#robot=" + robot};
}

/// Replaces the last `count` conditions by `larger`, which hides them.
void replace_last(Conditions& found, std::size_t count, Condition larger) {
  const auto those = found.end() - static_cast<std::ptrdiff_t>(count);
  larger.since = std::ranges::min_element(those, found.end(), {}, &Condition::since)->since;
  larger.hides = larger.degree = count;
  found.erase(those, found.end());
  found.push_back(std::move(larger));
}

/// Robots that have a habit, or were heard within the last minute.
std::size_t count_of_robots(const Traffic& traffic) {
  std::set<std::string> names;
  for (const auto& [name, habit] : traffic.habits) names.insert(name);
  for (const ActivityRow& row : traffic.activities) {
    if (!row.robot.empty() && row.heard && *row.heard <= kQuietAfter) names.insert(row.robot);
  }
  return names.size();
}

void find_silent(const Traffic& traffic, Conditions& found) {
  std::size_t count = 0;
  for (const auto& [name, habit] : traffic.habits) {
    if (!habit.silent) continue;
    ++count;
    found.push_back({.id = "robot_silent:" + name,
                     .side = Side::Robot,
                     .subject = name,
                     .since = traffic.now - habit.quiet,
                     .headline = {name, "silent"},
                     .why = sentence("it usually sends a message every ", age_text(std::max(habit.gap, 1.0))),
                     .action = show(name)});
  }
  const bool are_all = count == count_of_robots(traffic);
  if (count < 2 || (!are_all && count < kMany)) return;
  replace_last(found, count,
               {.id = "robots_silent",
                .side = Side::Robot,
                .headline = {sentence(are_all ? "All " : "", count, " robots"), "silent", true},
                .why = "check the team's network and the base station"});
}

/// The robot's map furthest behind, by more than `least` s without the endpoint's own trouble; or null.
const ActivityRow* find_most_delayed(const Traffic& traffic, const std::string& robot, double least) {
  const ActivityRow* longest = nullptr;
  for (const ActivityRow& row : traffic.activities) {
    const double its = queue_age(row, traffic).value_or(0);
    if (!row.is_map() || row.robot != robot || its <= least) continue;
    least = its;
    longest = &row;
  }
  return longest;
}

void find_late_maps(const Traffic& traffic, Conditions& found) {
  const double told = 2 * (kLateAfter + traffic.turn), stuck = std::max(kStuckAfter, 1.5 * told);
  std::vector<std::string> names;
  for (const ActivityRow& row : traffic.activities) {
    if (row.is_map()) names.push_back(row.robot);
  }
  std::ranges::sort(names, icd::NaturalOrder());
  names.erase(std::ranges::unique(names).begin(), names.end());
  std::size_t count = 0;
  for (const std::string& name : names) {
    const ActivityRow* const longest = find_most_delayed(traffic, name, told);
    if (longest == nullptr) continue;
    ++count;
    found.push_back({.id = "map_behind:" + name,
                     .severity = *queue_age(*longest, traffic) > stuck ? Severity::Bad : Severity::Wait,
                     .side = Side::CommandPost,
                     .subject = name,
                     .since = traffic.now - *longest->age,
                     .headline = {name.empty() ? "The merged map" : name + "'s map", "behind"},
                     .why = sentence("its newest ", longest->kind, " has not reached the Command Post",
                                     longest->last_status == static_cast<int>(icd::Status::ContentTooLarge)
                                         ? ", because it is too large"
                                         : ""),
                     .action = name.empty() ? Action{} : show(name)});
  }
  if (count < kMany) return;
  const bool bad = std::ranges::any_of(found.end() - static_cast<std::ptrdiff_t>(count), found.end(),
                                       [](const Condition& each) { return each.severity == Severity::Bad; });
  replace_last(found, count,
               {.id = "maps_behind",
                .severity = bad ? Severity::Bad : Severity::Wait,
                .side = Side::Network,
                .headline = {sentence("Maps of ", count, " robots"), "behind", true},
                .why = "the robots send more than the box can forward"});
}

void find_full_queue(const Traffic& traffic, Conditions& found) {
  std::string names;
  std::size_t count = 0;
  for (const ActivityRow& row : traffic.activities) {
    if (!row.last_no_room || facts::seconds_since(*row.last_no_room, traffic.now) > kNoRoomRecent) continue;
    if (++count > kNamed) continue;
    names += names.empty() ? "" : ", ";
    if (row.kind != "markers") names += (row.robot.empty() ? "merged" : row.robot) + " ";
    names += row.kind;
  }
  if (count > kNamed) names += sentence(" and ", count - kNamed, " more");
  const std::string full = sentence("the limit is ", traffic.queue_room / kMegabyte, " MB");
  if (count > 0) {
    found.push_back({.id = "queue_full",
                     .side = Side::Network,
                     .headline = {"The queue", "full"},
                     .why = "the box rejects messages until the queue has room: " + names});
  } else if (static_cast<double>(traffic.queued) > kNearlyFull * static_cast<double>(traffic.queue_room)) {
    found.push_back({.id = "queue_nearly_full",
                     .severity = Severity::Bad,
                     .side = Side::Network,
                     .headline = {"The map queue", "nearly full"},
                     .why = full});
  } else if (traffic.queue_grows) {
    found.push_back({.id = "queue_growing",
                     .severity = Severity::Wait,
                     .side = Side::Network,
                     .headline = {"The map queue", "growing"},
                     .why = sentence(traffic.queued / kMegabyte, " MB are queued")});
  }
}

void find_unknown(const facts::Clients& clients, const Traffic& traffic, Conditions& found) {
  const std::string known = icd::join_words(traffic.registered);
  for (const std::string& name : clients.unknown_robots) {
    found.push_back({.id = "robot_unknown:" + name,
                     .severity = Severity::Ask,
                     .side = Side::Robot,
                     .subject = name,
                     .headline = {"Robot " + name, "unknown"},
                     .why = "it sends messages, but set-up lists only " + known,
                     .action = {"Open set-up", "/setup#robots"}});
  }
}

void find_crowds(const facts::Clients& clients, Conditions& found) {
  for (const facts::Crowd& crowd : clients.crowds) {
    const std::string most = "most from " + crowd.address;
    if (crowd.kind == facts::Crowd::Kind::NoRoom) {
      found.push_back({.id = "clients_refused",
                       .side = Side::Robot,
                       .headline = {"Clients", "rejected", true},
                       .why = "too many requests at once, " + most,
                       .action = {"Open set-up", "/setup?setting=team.connections#all"}});
    } else if (crowd.kind == facts::Crowd::Kind::WrongToken) {
      found.push_back({.id = "wrong_tokens",
                       .severity = Severity::Ask,
                       .side = Side::Robot,
                       .headline = {"Wrong tokens", "in use", true},
                       .why = most,
                       .action = {"Open set-up", "/setup#tokens-team"}});
    } else if (crowd.kind == facts::Crowd::Kind::NoToken) {
      found.push_back({.id = "client_token",
                       .severity = Severity::Wait,
                       .side = Side::Robot,
                       .headline = {"A client", "without a token"},
                       .why = "it sends messages from " + crowd.address});
    } else {
      found.push_back({.id = "unauthenticated",
                       .severity = Severity::Wait,
                       .side = Side::Robot,
                       .headline = {"Too many clients", "anonymous", true},
                       .why = most});
    }
  }
  if (!clients.shut_out) return;
  found.push_back({.id = "no_token:team",
                   .side = Side::Box,
                   .subject = "team",
                   .headline = {"The team token", "missing"},
                   .why = "the box rejects every robot",
                   .action = {"Open set-up", "/setup#tokens-team"}});
}

}  // namespace

void find_robot_troubles(const Traffic& traffic, const facts::Clients& clients, Conditions& found) {
  find_silent(traffic, found);
  find_late_maps(traffic, found);
  find_full_queue(traffic, found);
  find_unknown(clients, traffic, found);
  find_crowds(clients, found);
}

}  // namespace adit::alarms
