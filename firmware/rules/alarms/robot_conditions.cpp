// Conditions of the robots, their maps, and the clients.
#include <algorithm>

#include "alarms/alarm.hpp"
#include "alarms/conditions.hpp"
#include "alarms/verdict.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"
#include "icd/text.hpp"

namespace adit::alarms {
namespace {

using icd::sentence;

constexpr std::size_t kMegabyte = 1'000'000;
constexpr double kNoRoomRecent = 60;    // seconds that a rejection for want of room is reported
constexpr std::size_t kNamed = 3;       // robots named in a sentence
constexpr std::size_t kManyBehind = 4;  // robots that share one condition

Action show(const std::string& robot) {
  return {"Show robot", "/#robot=" + robot};
}

/// Replaces the last `count` conditions by `larger`, which hides them.
void put_in_place_of(Found& found, std::size_t count, Condition larger) {
  const auto those = found.end() - static_cast<std::ptrdiff_t>(count);
  larger.since = std::ranges::min_element(those, found.end(), {}, &Condition::since)->since;
  larger.hides = larger.degree = count;
  found.erase(those, found.end());
  found.push_back(std::move(larger));
}

void find_silent(const Facts& facts, Found& found) {
  std::size_t count = 0;
  for (const auto& [name, robot] : facts.robots) {
    if (!robot.silent) continue;
    ++count;
    found.push_back({.id = "robot_silent:" + name,
                     .side = Side::Robot,
                     .subject = name,
                     .since = facts.now - robot.quiet,
                     .headline = {name, "silent"},
                     .why = sentence("it usually sends a message every ", age_text(std::max(robot.gap, 1.0))),
                     .action = show(name)});
  }
  if (count < 2 || count < facts.robots.size()) return;
  put_in_place_of(found, count,
                  {.id = "robots_silent",
                   .side = Side::Robot,
                   .headline = {sentence("All ", count, " robots"), "silent", true},
                   .why = "check the team's network and the base station"});
}

/// The robot's map that is furthest behind, and more than `least` seconds, without the endpoint's own
/// trouble; or null.
const Stream* longest_behind(const Facts& facts, const std::string& robot, double least) {
  const Stream* longest = nullptr;
  for (const Stream& stream : facts.streams) {
    const double its = waited(stream, facts).value_or(0);
    if (!stream.is_map() || stream.robot != robot || its <= least) continue;
    least = its;
    longest = &stream;
  }
  return longest;
}

void find_behind(const Facts& facts, Found& found) {
  const double told = 2 * (kLateAfter + facts.turn), stuck = std::max(kStuckAfter, 1.5 * told);
  std::vector<std::string> names;
  for (const Stream& stream : facts.streams) {
    if (stream.is_map()) names.push_back(stream.robot);
  }
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  std::size_t count = 0;
  for (const std::string& name : names) {
    const Stream* const longest = longest_behind(facts, name, told);
    if (longest == nullptr) continue;
    ++count;
    found.push_back({.id = "map_behind:" + name,
                     .severity = *waited(*longest, facts) > stuck ? Severity::Bad : Severity::Wait,
                     .side = Side::CommandPost,
                     .subject = name,
                     .since = facts.now - *longest->behind,
                     .headline = {name.empty() ? "The merged map" : name + "'s map", "behind"},
                     .why = sentence("its newest ", longest->kind, " has not reached the Command Post",
                                     longest->last_status == static_cast<int>(icd::Status::ContentTooLarge)
                                         ? ", because it is too large"
                                         : ""),
                     .action = name.empty() ? Action{} : show(name)});
  }
  if (count < kManyBehind) return;
  const bool bad = std::ranges::any_of(found.end() - static_cast<std::ptrdiff_t>(count), found.end(),
                                       [](const Condition& each) { return each.severity == Severity::Bad; });
  put_in_place_of(found, count,
                  {.id = "maps_behind",
                   .severity = bad ? Severity::Bad : Severity::Wait,
                   .side = Side::Network,
                   .headline = {sentence("Maps of ", count, " robots"), "behind", true},
                   .why = "the robots send more than the box can forward"});
}

void find_full_queue(const Facts& facts, Found& found) {
  std::string names;
  std::size_t count = 0;
  for (const Stream& stream : facts.streams) {
    if (!stream.no_room || *stream.no_room > kNoRoomRecent) continue;
    if (++count > kNamed) continue;
    names += names.empty() ? "" : ", ";
    if (stream.kind != "markers") names += (stream.robot.empty() ? "merged" : stream.robot) + " ";
    names += stream.kind;
  }
  if (count > kNamed) names += sentence(" and ", count - kNamed, " more");
  const std::string full = sentence("the limit is ", facts.queue_room / kMegabyte, " MB");
  if (count > 0) {
    found.push_back({.id = "queue_full",
                     .side = Side::Network,
                     .headline = {"The queue", "full"},
                     .why = "the box rejects messages until the queue has room: " + names});
  } else if (static_cast<double>(facts.queued) > kNearlyFull * static_cast<double>(facts.queue_room)) {
    found.push_back({.id = "queue_nearly_full",
                     .severity = Severity::Bad,
                     .side = Side::Network,
                     .headline = {"The map queue", "nearly full"},
                     .why = full});
  } else if (facts.queue_grows) {
    found.push_back({.id = "queue_growing",
                     .severity = Severity::Wait,
                     .side = Side::Network,
                     .headline = {"The map queue", "growing"},
                     .why = sentence(facts.queued / kMegabyte, " MB are queued")});
  }
}

void find_unknown(const Facts& facts, Found& found) {
  const std::string known = icd::listed(facts.known_robots);
  for (const std::string& name : facts.unknown_robots) {
    found.push_back({.id = "robot_unknown:" + name,
                     .severity = Severity::Ask,
                     .side = Side::Robot,
                     .subject = name,
                     .headline = {"Robot " + name, "unknown"},
                     .why = "it sends messages, but set-up lists only " + known,
                     .action = {"Open set-up", "/setup#robots"}});
  }
}

void find_crowds(const Facts& facts, Found& found) {
  for (const CrowdFact& crowd : facts.crowds) {
    const std::string most = "most of them from " + crowd.address;
    if (crowd.is == CrowdFact::Is::NoRoom) {
      found.push_back({.id = "clients_refused",
                       .side = Side::Robot,
                       .headline = {"Clients", "rejected", true},
                       .why = "too many requests at once, " + most,
                       .action = {"Open set-up", "/setup?setting=team.connections#all"}});
    } else if (crowd.is == CrowdFact::Is::WrongToken) {
      found.push_back({.id = "wrong_tokens",
                       .severity = Severity::Ask,
                       .side = Side::Robot,
                       .headline = {"Wrong tokens", "in use", true},
                       .why = most,
                       .action = {"Open set-up", "/setup#tokens"}});
    } else {
      found.push_back({.id = "unauthenticated",
                       .severity = Severity::Wait,
                       .side = Side::Robot,
                       .headline = {"Too many clients", "anonymous", true},
                       .why = most});
    }
  }
  if (!facts.shut_out) return;
  found.push_back({.id = "no_token:team",
                   .side = Side::Box,
                   .subject = "team",
                   .headline = {"The team token", "missing"},
                   .why = "the box rejects every robot",
                   .action = {"Open set-up", "/setup#tokens"}});
}

}  // namespace

void find_robot_troubles(const Facts& facts, Found& found) {
  find_silent(facts, found);
  find_behind(facts, found);
  find_full_queue(facts, found);
  find_unknown(facts, found);
  find_crowds(facts, found);
}

}  // namespace adit::alarms
