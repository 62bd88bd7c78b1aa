#include <gmock/gmock.h>

#include "cli/status_text.hpp"
#include "cli/view.hpp"

namespace adit::cli {
namespace {

using testing::IsEmpty;

/// The lines without their leading times.
std::string changed(const api::RunView& before, const api::RunView& now) {
  std::string rest = changes_text(before, now, false), lines;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n') + 1;
    EXPECT_TRUE(rest.starts_with("1970-01-01T00:16:4")) << rest;
    lines += rest.substr(rest.find("  ") + 2, end - rest.find("  ") - 2);
    rest.erase(0, end);
  }
  return lines;
}

/// The sample one second later.
api::RunView later() {
  api::RunView view = sample_view();
  view.now += 1;
  view.run->run_clock += 1;
  return view;
}

TEST(Watching, PrintsNothingIfOnlyTheClockChanges) {
  EXPECT_THAT(changed(sample_view(), later()), IsEmpty());
}

TEST(Watching, PrintsAlarmsAndTheirEnd) {
  api::RunView now = later();
  now.alarms = {{.id = "report_in_doubt:7", .what = "Report 7 is in doubt", .why = "no answer came"}};
  EXPECT_EQ(changed(sample_view(), now), "ALARM  Report 7 is in doubt: no answer came\n");
  EXPECT_EQ(changed(now, later()), "alarm over: Report 7 is in doubt: no answer came\n");
  EXPECT_THAT(changed(now, now), IsEmpty());
}

TEST(Watching, PrintsChangesOfTheRun) {
  api::RunView now = later();
  now.run->score = 8;
  now.run->remaining_reports = 17;
  EXPECT_EQ(changed(sample_view(), now), "run 12:35: score 8, 17 reports left, team cave_club\n");
  now.run.reset();
  now.run_number = 2;
  EXPECT_EQ(changed(sample_view(), now), "run 2 begins\nrun: no status from the Command Post yet\n");
}

TEST(Watching, PrintsChangesOfReports) {
  api::RunView now = later();
  now.reports.front().state = "settled";
  now.reports.front().reconciled = true;
  now.reports.push_back(now.reports.front());
  now.reports.back().number = 4;
  now.reports.back().state = "held";
  now.reports.back().note = "a near duplicate of report 3";
  now.reports.back().score_change.reset();
  EXPECT_EQ(changed(sample_view(), now),
            "report 3 Survivor: settled, score +1\n"
            "report 4 Survivor: held (a near duplicate of report 3)\n");
}

TEST(Watching, PrintsNothingForAnOlderReportThatFindsRoomInTheList) {
  api::RunView before = sample_view();
  const facts::ReportRow held = {.number = 0, .type = "Rope", .changed = before.now - 60, .state = "held"};
  before.reports.assign(api::RunView::kMostReports, held);
  auto number = static_cast<std::int64_t>(before.reports.size()) + 1;
  for (facts::ReportRow& report : before.reports) report.number = number--;
  api::RunView now = before;
  now.now += 1;
  now.reports.erase(now.reports.begin());
  now.reports.push_back(held);
  now.reports.back().number = 1;
  EXPECT_THAT(changed(before, now), IsEmpty());
  now.reports.back().changed = before.now + 0.5;
  EXPECT_EQ(changed(before, now), "report 1 Rope: held\n");
}

TEST(Watching, PrintsChangesOfEndpointsAndRobots) {
  api::RunView now = later();
  now.endpoints[1].word = "unreachable";
  now.endpoints[1].trouble = "no route to host";
  now.activities[0].last_status = 500;
  now.activities[0].last_sentence = "it failed";
  now.activities[0].arrival = facts::Arrival::Failing;
  EXPECT_EQ(changed(sample_view(), now),
            "mapping endpoint: unreachable, no route to host\nr1, grid: NOT ARRIVING: it failed\n");
  EXPECT_EQ(changed(now, later()), "mapping endpoint: connected\nr1, grid: arrives\n");
}

TEST(Watching, PrintsNothingForARobotLateInItsTurn) {
  api::RunView now = later();
  now.activities[0].arrival = facts::Arrival::Late;
  EXPECT_THAT(changed(sample_view(), now), IsEmpty());
}

TEST(Watching, EscapesForeignText) {
  api::RunView now = later();
  now.alarms = {{.id = "x", .what = "from\x1b[2J\na robot"}};
  EXPECT_EQ(changed(sample_view(), now), "ALARM  from\\x1b[2J\\x0aa robot\n");
}

TEST(Screen, ShowsTheLinesThatFit) {
  EXPECT_EQ(fit("one\ntwo\n", 5, 10), "one\ntwo");
  EXPECT_EQ(fit("one\ntwo\nthree\n", 2, 20), "one\n... 2 more lines");
  EXPECT_EQ(fit("one\ntwo\nthree\n", 1, 20), "... 3 more lines");
  EXPECT_EQ(fit("one\n", 0, 20), "");
  EXPECT_EQ(fit("", 3, 20), "");
}

TEST(Screen, CutsLinesByTheirVisibleWidth) {
  EXPECT_EQ(fit("abcdef\n", 3, 4), "abcd\033[0m");
  EXPECT_EQ(fit("Höhle\n", 3, 5), "Höhle");
  EXPECT_EQ(fit("Höhlen\n", 3, 2), "Hö\033[0m");
  EXPECT_EQ(fit("\033[31mab\033[0mcd\n", 3, 4), "\033[31mab\033[0mcd");
  EXPECT_EQ(fit("\033[31mabc\033[0m\n", 3, 2), "\033[31mab\033[0m");
}

}  // namespace
}  // namespace adit::cli
