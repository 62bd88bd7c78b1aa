#include "api/run_view.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "api/judged.hpp"
#include "api/scenes.hpp"

namespace adit::api {
namespace {

using nlohmann::json;

TEST(RunView, HasNoPlaceForAReportThatIsLost) {
  RunView view = *scene("trouble", 1000.5, 3);
  view.reports[0].position.reset();
  const json parsed = json::parse(codec::to_json(view));
  EXPECT_EQ(parsed["reports"][0]["position"], nullptr);
  EXPECT_TRUE(parsed["reports"][1]["position"].is_object());
}

/// One for page, `adit status`, metrics and alarms.
TEST(RunView, HasTheAgesThatTheAlarmsGoBy) {
  RunView view;
  view.activities.resize(2);
  view.activities[0].last_forwarded = view.activities[0].behind_since = 975;
  view.robots = {{.name = "r", .position = {}, .at = 1010}};
  alarms::Facts facts{.now = 1000};
  facts.streams = streams_of(view.activities, facts.now);
  facts.streams[0].forwarded = 26;
  judge(view, facts);
  EXPECT_EQ(view.activities[0].age, 26);
  EXPECT_EQ(view.activities[0].behind, 25);
  EXPECT_EQ(view.activities[1].age, std::nullopt);
  EXPECT_EQ(view.robots[0].age, 0) << "never negative";
}

TEST(RunView, SaysHowOldTheRobotsOwnDataIsAndNotWhenItWasForwarded) {
  RunView view;
  view.activities.resize(2);
  for (ActivityRow& row : view.activities) row.robot = "r";
  view.activities[0].kind = "state", view.activities[1].kind = "grid";
  view.activities[0].last_accepted = 906, view.activities[0].last_forwarded = 999;
  view.activities[1].last_accepted = 999, view.activities[1].last_forwarded = 980;
  view.robots = {{.name = "r", .position = {}, .at = 999}, {.name = "before", .position = {}}};
  alarms::Facts facts{.now = 1000};
  facts.streams = streams_of(view.activities, facts.now);
  judge(view, facts);
  EXPECT_EQ(view.activities[0].age, 94) << "it was queued for long";
  EXPECT_EQ(view.activities[1].age, 20) << "the newest one was not delivered";
  EXPECT_EQ(view.robots[0].age, 94);
  EXPECT_EQ(view.robots[1].age, std::nullopt) << "before a start of the machine";
}

TEST(RunViewJson, NamesEachMemberAsTheViewDoes) {
  const RunView view = *scene("trouble", 1000.5, 3);
  const json parsed = json::parse(codec::to_json(view));
  EXPECT_EQ(parsed["refusals"][0]["parts"], 0);
  EXPECT_EQ(parsed["now"], 1000.5);
  EXPECT_EQ(parsed["run"]["score"], 7);
  EXPECT_EQ(parsed["run"]["run_clock"], 757.0);
  EXPECT_EQ(parsed["run"]["remaining_reports"], 18);
  EXPECT_EQ(parsed["run"]["current_team"], "Cerberus");
  EXPECT_EQ(parsed["endpoints"][1]["trouble"], "connecting to 10.100.1.201:8000: Connection refused");
  EXPECT_EQ(parsed["endpoints"][0]["connected"], true);
  EXPECT_EQ(parsed["endpoints"][0]["answer_ms"], 3.4);
  EXPECT_EQ(parsed["reports"][0]["number"], 10);
  EXPECT_EQ(parsed["reports"][2]["state"], "in_doubt");
  EXPECT_EQ(parsed["reports"][3]["position"], (json{{"x", 85.75}, {"y", -4.5}, {"z", 0.25}}));
  EXPECT_EQ(parsed["reports"][3]["score_change"], 1);
  EXPECT_EQ(parsed["activities"][2]["merged"], 96);
  EXPECT_EQ(parsed["activities"][1]["queued"], 12);
  EXPECT_EQ(parsed["refusals"][0]["status"], 422);
  EXPECT_EQ(parsed["lights"][3], (json{{"name", "attention"}, {"pattern", "fast"}}));
  EXPECT_EQ(parsed["budget_mbit"], 100.0);
  EXPECT_EQ(parsed["endpoints"][1]["throttled"], 3);
  EXPECT_EQ(parsed["near_metres"], 5.0);
  EXPECT_EQ(parsed["robots"][0], (json{{"name", "ANYmal1"},
                                       {"position", {{"x", 24.0}, {"y", 6.0}, {"z", 0.5}}},
                                       {"heading", 0.5},
                                       {"at", view.robots[0].at.value()},
                                       {"age", view.robots[0].age.value()}}));
  EXPECT_EQ(parsed["identify_until"], nullptr);
  EXPECT_EQ(parsed["setup_open_until"], nullptr);
  EXPECT_EQ(parsed["run_number"], 1);
  EXPECT_EQ(parsed["run_id"], "");
  EXPECT_EQ(parsed["queued_bytes"], 214'000'000);
  EXPECT_EQ(parsed["alarms"].size(), 3);
  EXPECT_EQ(parsed["verdict"]["what"], "3 of 4 arrive");
}

TEST(RunViewJson, TellsTheVersionsOfThePicturesToTheLastDigit) {
  RunView view;
  view.map_version = 1'793'000'123'456;
  view.marker_version = 1'793'000'123'457;
  view.identify_until = 12.5;
  view.setup_open_until = 13.5;
  const json parsed = json::parse(codec::to_json(view));
  EXPECT_EQ(parsed["map_version"], 1'793'000'123'456);
  EXPECT_EQ(parsed["marker_version"], 1'793'000'123'457);
  EXPECT_EQ(parsed["identify_until"], 12.5);
  EXPECT_EQ(parsed["setup_open_until"], 13.5);
}

TEST(RunViewJson, TellsOfEachReportWhoseWordItWaitsFor) {
  const json parsed = json::parse(codec::to_json(*scene("reports", 1000, 0)));
  EXPECT_EQ(parsed["run_number"], 2);
  EXPECT_EQ(parsed["run_id"], "cave-2");
  EXPECT_EQ(parsed["reports"][2]["asking"], true);
  EXPECT_EQ(parsed["reports"][3]["asking"], false);
  EXPECT_EQ(parsed["reports"][5]["reconciled"], true);
  EXPECT_EQ(parsed["reports"][7]["same_as"], 17);
  EXPECT_EQ(parsed["reports"][10]["run"], 1);
}

TEST(RunViewJson, WritesWhatIsAbsentAsNull) {
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

TEST(RunViewJson, IsOneLineOfJsonWhateverTheTextsHold) {
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
