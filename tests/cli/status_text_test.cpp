#include "cli/status_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/run_adit.hpp"
#include "cli/view.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(StatusText, ShowsAGoodRunOnOneScreen) {
  EXPECT_EQ(
      status_text(sample_view(), false),
      "Run   12:34   47:25 to go   score 7   18 reports left   team cave_club   (heard 0.4 s ago)\n"
      "Link  12.3 of 100 Mbit/s   3.4 MB of maps queued\n"
      "Reports  1 answered\n"
      "\n"
      "Command Post\n"
      "  scoring  10.100.1.200:8000  connected  last answer: accepted in 3.4 ms\n"
      "  mapping  10.100.1.201:8000  connected  last answer: accepted in 42 ms\n"
      "\n"
      "Maps, states and markers\n"
      "  robot  kind  arriving    accepted  sent  queued  no room    age      heard  size  last answer\n"
      "  r1     grid  up to date        12    11       0           0.5 s  0.4 s ago  4 kB  accepted\n");
}

TEST(StatusText, MarksAnEstimateOfTheRunClock) {
  api::RunView view = sample_view();
  view.run_clock = {.seconds = 790, .age = 35.4, .runs = true, .old = true};
  EXPECT_THAT(
      status_text(view, false),
      StartsWith("Run   about 13:10   about 46:50 to go   score 7   18 reports left   team cave_club   "
                 "(heard 35 s ago)\n"));
  view.run_clock = {.seconds = 754, .age = 35.4, .old = true};
  EXPECT_THAT(status_text(view, false), StartsWith("Run   12:34   47:26 to go ")) << "the clock stands still";
}

TEST(StatusText, BeginsWithTheAlarms) {
  api::RunView view = sample_view();
  view.alarms = {
      {.id = "robot_silent:r2", .since = 906, .what = "r2 is silent", .why = "its habit is 2 s", .hides = 3},
      {.id = "report_in_doubt:7",
       .severity = alarms::Severity::Ask,
       .side = alarms::Side::CommandPost,
       .since = 990,
       .what = "Report 7 is in doubt",
       .acknowledged = true},
      {.id = "reports_left",
       .severity = alarms::Severity::Wait,
       .since = 1000,
       .what = "5 reports are left"}};
  view.verdict = {facts::Level::Bad, "1 of 2 arrive", "not r2"};
  const std::string text = status_text(view, false);
  EXPECT_THAT(text, StartsWith("  x r2 is silent (94 s, hides 3): its habit is 2 s\n"
                               "  ? Report 7 is in doubt (10 s, acknowledged)\n"
                               "  ! 5 reports are left (0 s)\n\nRun "));
  EXPECT_THAT(text, HasSubstr("\nMaps  1 of 2 arrive: not r2\n"));
}

TEST(StatusText, ShowsTheStandingOfAnEndpoint) {
  api::RunView view = sample_view();
  view.endpoints[1].word = "unreachable";
  view.endpoints[1].trouble = "Connection refused";
  EXPECT_THAT(status_text(view, false),
              testing::ContainsRegex("8000  unreachable  .*  Connection refused\n"));
}

TEST(StatusText, IsCompleteBeforeTheFirstMessage) {
  EXPECT_EQ(
      status_text({}, false),
      "Run   no status from the Command Post yet\nLink  0 of 0 Mbit/s   0 B of maps queued\nReports  0\n");
}

TEST(StatusText, SaysIfItCountsOnlyTheLastReports) {
  api::RunView view = sample_view();
  view.reports.assign(api::RunView::kMostReports - 1, view.reports.front());
  EXPECT_THAT(status_text(view, false), HasSubstr("Reports  199 answered\n"));
  view.reports.push_back(view.reports.front());
  EXPECT_THAT(status_text(view, false), HasSubstr("Reports  200 answered (of the last 200)\n"));
}

TEST(StatusText, ShowsTheLatestRejections) {
  api::RunView view = sample_view();
  view.refusals = {{.at = 998,
                    .uri = "/map/update",
                    .sender = "10.0.0.7",
                    .status = 422,
                    .sentence = "msg.info.width: expected 80 x 60 = 4800 bytes of data, got 4799"}};
  EXPECT_THAT(
      status_text(view, false),
      HasSubstr(
          "Rejected from clients, newest first\n  2 s ago  10.0.0.7  /map/update  422  msg.info.width: "));
}

TEST(StatusText, EscapesTerminalSequences) {
  api::RunView view = sample_view();
  view.run->current_team = "\x1b]0;a\x07";
  view.activities[0].robot = "\x1b[2J";
  view.activities[0].last_sentence = "\x1b[2J\nRun   99:99";
  view.alarms = {{.what = "\x1b[2J", .why = "\x1b[2J"}};
  view.verdict = {facts::Level::Bad, "No map arrives", "\x1b[2J"};
  view.endpoints[0].trouble = "\x1b[2J";
  view.reports[0].state = "\x1b[2J";
  view.refusals = {{.at = 0, .uri = "\x1b[2J", .sender = "\x1b[2J", .status = 422, .sentence = "\x1b[2J"}};
  EXPECT_THAT(status_text(view, false), Not(HasSubstr("\x1b")));
}

TEST(StatusText, ShowsBacklogAndRejectionsOfARobot) {
  api::RunView view = sample_view();
  view.activities[0].word = "33 s behind";
  view.activities[0].queued = 247;
  view.activities[0].no_room = 1110;
  EXPECT_THAT(status_text(view, false),
              HasSubstr("  r1     grid  33 s behind        12    11     247     1110"));
}

TEST(StatusText, IsExplainedInTheHelp) {
  for (const std::string_view word : facts::kArrivalWords) {
    const std::string shown(word == "late" ? "behind" : word);
    EXPECT_THAT(help_of("status"), testing::ContainsRegex("  .*" + shown + ".*  "));
  }
}

TEST(StatusText, ShowsTheTreatmentOfARobotsClouds) {
  api::RunView view = sample_view();
  facts::ActivityRow& row = view.activities[0];
  row.kind = "cloud", row.clouds = "parts", row.precision = "exact";
  EXPECT_THAT(status_text(view, false), HasSubstr("  r1     cloud, parts  "));
  row.precision = "8mm";
  EXPECT_THAT(status_text(view, false), HasSubstr("  r1     cloud, parts, to 8mm  "));
  row.no_valid_point = 2;
  EXPECT_THAT(status_text(view, false),
              HasSubstr("  r1     cloud, parts, to 8mm, 2 without a valid point  "));
  row = {};
  row.kind = "markers", row.invisible = 3;
  EXPECT_THAT(status_text(view, false), HasSubstr("  (all)  markers, 3 invisible  "));
}

}  // namespace
}  // namespace adit::cli
