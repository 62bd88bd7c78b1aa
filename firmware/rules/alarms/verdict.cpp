#include "alarms/verdict.hpp"

#include <algorithm>
#include <map>

#include "alarms/alarm.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"

namespace adit::alarms {
namespace {

const Endpoint* mapping(const Facts& facts) {
  const auto found = std::ranges::find(facts.endpoints, "mapping", &Endpoint::name);
  return found == facts.endpoints.end() ? nullptr : &*found;
}

/// Whether the stream's last result may date from when the endpoint was stopped.
bool is_catching_up(const Stream& stream, const Facts& facts) {
  const Endpoint* const endpoint = mapping(facts);
  return endpoint != nullptr && endpoint->well_for && *endpoint->well_for < kLateAfter + facts.turn &&
         (stream.behind || stream.failed || icd::concerns_all_messages(stream.last_status));
}

using icd::sentence;

constexpr codec::Member kVerdict[] = {
    codec::member<&Verdict::level>("level").one_of(kLevelWords),
    codec::member<&Verdict::what>("what", "whether every map arrives, in few words"),
    codec::member<&Verdict::why>("why", "which do not, and how old the others are; may be empty"),
};

/// The maps of one robot.
struct Maps {
  Level level = Level::Quiet;
  // Seconds: age or delay of the oldest map that is not quiet, and age of the newest map.
  std::optional<double> oldest = {}, newest = {};
};

std::map<std::string, Maps> maps_of(const Facts& facts) {
  std::map<std::string, Maps> all;
  for (const Stream& stream : facts.streams) {
    if (!stream.is_map()) continue;
    Maps& maps = all[stream.robot];
    const Level level = standing_of(stream, facts).level;
    maps.level = std::max(maps.level, level);
    if (!stream.forwarded) continue;
    maps.newest = std::min(*stream.forwarded, maps.newest.value_or(*stream.forwarded));
    if (level == Level::Quiet) continue;
    const double age = std::min(*stream.forwarded, stream.behind.value_or(*stream.forwarded));
    maps.oldest = std::max(age, maps.oldest.value_or(0));
  }
  for (const std::string& name : unheard(facts)) all[name].level = Level::Bad;
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
  return endpoint != nullptr && endpoint->trouble < EndpointTrouble::Throttling ? endpoint : nullptr;
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
                            (arrival == Arrival::Refused && icd::concerns_all_messages(stream.last_status));
  if (is_of_before && is_catching_up(stream, facts)) return {Arrival::Late, Level::Wait};
  return {arrival, level};
}

constexpr codec::Row Verdict::kRow = {"Verdict", kVerdict, "Is my map arriving?"};

Verdict verdict_of(const Facts& facts) {
  const auto all = maps_of(facts);
  if (const Endpoint* endpoint = stopped(facts); endpoint != nullptr && !all.empty()) {
    const std::string why = endpoint->trouble == EndpointTrouble::NoToken
                                ? "the mapping token is missing"
                                : "for " + clock_text(facts.now - endpoint->since);
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
