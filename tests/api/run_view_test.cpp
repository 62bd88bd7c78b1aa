#include "api/run_view.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "alarms/alarm.hpp"
#include "alarms/board.hpp"
#include "alarms/conditions.hpp"
#include "api/scenes.hpp"
#include "api/verdicts.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

using nlohmann::json;

TEST(RunView, HasNoPositionForALostReport) {
  RunView view = *scene("trouble", 1000.5, 3);
  view.reports[0].position.reset();
  const json parsed = json::parse(codec::to_json(view));
  EXPECT_EQ(parsed["reports"][0]["position"], nullptr);
  EXPECT_TRUE(parsed["reports"][1]["position"].is_object());
}

/// The page, `adit status`, metrics and alarms use the same ages.
TEST(RunView, HasTheAgesThatAlarmsUse) {
  RunView view;
  view.activities.resize(2);
  view.activities[0].last_forwarded = view.activities[0].behind_since = 975;
  view.robots = {{.name = "r", .position = {}, .at = 1010}};
  alarms::Facts facts{.now = 1000};
  facts.streams = streams_of(view.activities, facts.now);
  facts.streams[0].forwarded = 26;
  add_verdicts(view, facts);
  EXPECT_EQ(view.activities[0].age, 26);
  EXPECT_EQ(view.activities[0].behind, 25);
  EXPECT_EQ(view.activities[1].age, std::nullopt);
  EXPECT_EQ(view.robots[0].age, 0) << "an age is never negative";
}

TEST(RunView, ShowsTheAgeOfRobotDataNotOfItsDelivery) {
  RunView view;
  view.activities.resize(2);
  for (ActivityRow& row : view.activities) row.robot = "r";
  view.activities[0].kind = "state", view.activities[1].kind = "grid";
  view.activities[0].last_accepted = 906, view.activities[0].last_forwarded = 999;
  view.activities[1].last_accepted = 999, view.activities[1].last_forwarded = 980;
  view.robots = {{.name = "r", .position = {}, .at = 999}, {.name = "before", .position = {}}};
  alarms::Facts facts{.now = 1000};
  facts.streams = streams_of(view.activities, facts.now);
  add_verdicts(view, facts);
  EXPECT_EQ(view.activities[0].age, 94) << "the message was queued for long";
  EXPECT_EQ(view.activities[1].age, 20) << "the newest message was not delivered";
  EXPECT_EQ(view.robots[0].age, 94);
  EXPECT_EQ(view.robots[1].age, std::nullopt) << "the time is from before the boot";
}

alarms::Stream of(const char* kind, std::optional<double> age, int status = 200,
                  std::optional<double> behind = {}) {
  return {.kind = kind, .robot = "r", .behind = behind, .forwarded = age, .last_status = status};
}

const struct {
  const char* what;
  std::vector<alarms::Stream> streams;
  const char* standing;
  bool silent = false;
  alarms::EndpointTrouble mapping = alarms::EndpointTrouble::None;
} kStandings[] = {
    {"worst kind, oldest map",
     {of("grid", 3), of("cloud", 40, 200, 33), of("state", 99)},
     "wait, 33 s behind, map 40 s"},
    {"first of two as bad", {of("grid", 3, 422), of("cloud", 4)}, "bad, refused, silent, map 4 s", true},
    {"a quiet map beside another", {of("grid", 600), of("cloud", 4)}, "good, up to date, map 4 s"},
    {"two quiet maps", {of("grid", 600), of("cloud", 99), of("state", 70)}, "quiet, quiet, map 1 min"},
    {"a map never delivered", {of("grid", {}), of("cloud", 4)}, "wait, waiting, map never"},
    {"no map", {of("state", 4)}, "good, up to date, 4 s"},
    {"nothing heard: as old as its last pose", {}, "bad, silent, silent, 34 s", true},
    {"nothing heard while the endpoint is down", {}, "", true, alarms::EndpointTrouble::Silent},
};

TEST(RunView, ShowsTheStandingOfARobot) {
  for (const auto& each : kStandings) {
    alarms::Facts facts{.now = 1000, .robots = {{"r", {.silent = each.silent}}}, .streams = each.streams};
    facts.endpoints = {{.name = "mapping", .trouble = each.mapping}};
    facts.streams.push_back({.kind = "grid", .robot = "", .forwarded = 4});
    RunView view;
    view.robots = {{.name = "r", .position = {}, .at = 966}};
    view.activities.resize(facts.streams.size());
    for (std::size_t i = 0; i < facts.streams.size(); ++i)
      view.activities[i].kind = facts.streams[i].kind, view.activities[i].robot = facts.streams[i].robot;
    add_verdicts(view, facts);
    std::string standing;
    for (const auto& [name, level, word, silent, has_map, age] : view.standings)
      standing += icd::sentence(alarms::kLevelWords[static_cast<std::size_t>(level)], ", ", word,
                                silent ? ", silent, " : ", ", has_map ? "map " : "",
                                age ? alarms::age_text(*age) : "never");
    EXPECT_EQ(standing, each.standing) << each.what;
  }
}

std::string standing_of(const EndpointRow& row, const alarms::Facts& facts = {}) {
  RunView view;
  view.endpoints = {row};
  view.alarms = alarms::Board().shown(alarms::conditions_of(facts), facts.now);
  add_verdicts(view, facts);
  const auto level = static_cast<std::size_t>(view.endpoints[0].level);
  return icd::sentence(alarms::kLevelWords[level], " ", view.endpoints[0].word);
}

TEST(RunView, ShowsTheStandingOfAnEndpoint) {
  using enum alarms::EndpointTrouble;
  EndpointRow row{.name = "mapping"};
  EXPECT_EQ(standing_of(row), "wait not connected");
  row.connected = true, row.trouble = "t";
  EXPECT_EQ(standing_of(row), "wait retrying");
  row.last_status = 422;
  EXPECT_EQ(standing_of(row), "wait status 422");
  row.trouble = "", row.last_status = 200, row.connected = false;
  std::vector<std::string> all;
  for (const auto trouble : {NoToken, Unreachable, Foreign, Refusing, Silent, Failing, Throttling})
    all.push_back(standing_of(row, {.endpoints = {{.name = "mapping", .trouble = trouble}}}));
  EXPECT_THAT(all, testing::ElementsAre("bad no token", "bad unreachable", "bad wrong host", "bad refused",
                                        "bad silent", "bad failing", "wait slow down"));
  EXPECT_EQ(standing_of(row, {.endpoints = {{.name = "scoring", .trouble = Silent}}}), "good connected");
  row.connected = true, row.last_status = 0;
  EXPECT_EQ(standing_of(row, {.cables = {{true, "team0", false}}}), "good connected");
  EXPECT_EQ(standing_of(row, {.cables = {{false, "darpa0", false}}}), "bad cable out");
  EXPECT_EQ(standing_of(row, {.network = {.no_address = true}}), "bad no address");
  EXPECT_EQ(standing_of(row, {.network = {.exchanged = alarms::SwappedAddress{}}}), "bad cables exchanged");
}

TEST(RunViewJson, WritesAbsentValuesAsNull) {
  RunView view = *scene("empty", 0, 0);
  view.activities.emplace_back();
  view.reports.emplace_back();
  const json parsed = json::parse(codec::to_json(view));
  EXPECT_TRUE(parsed.at("run").is_null());
  EXPECT_TRUE(parsed.at("run_clock").is_null());
  EXPECT_TRUE(parsed.at("endpoints")[0].at("answer_ms").is_null());
  EXPECT_TRUE(parsed.at("activities")[0].at("last_forwarded").is_null());
  EXPECT_TRUE(parsed.at("reports")[0].at("score_change").is_null());
}

TEST(RunViewJson, IsOneLineOfJsonForAnyText) {
  RunView view = *scene("hostile", 1000, 0);
  view.alarms.front().why = std::string("two\nlines\r\n\n\xc3(\0\x01\x7f\xed\xa0\x80");
  view.sent_mbit = std::numeric_limits<double>::quiet_NaN();
  const std::string text = codec::to_json(view);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_TRUE(json::accept(text));
  EXPECT_TRUE(json::parse(text)["sent_mbit"].is_null());
}

}  // namespace
}  // namespace adit::api
