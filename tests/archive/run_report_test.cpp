#include "archive/run_report.hpp"

#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "archive/a_run.hpp"
#include "archive/plot.hpp"

namespace adit::archive {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kHostile = "<script>alert('1')</script>\"&\x01";

api::KeptRun hostile_run() {
  ARun run;
  run.draw(2);
  api::KeptRun kept{run.facts, std::move(run.easel.mosaic), run.tracks, {}};
  kept.facts.course = kept.facts.team = kept.facts.id = kept.facts.post = kHostile;
  kept.facts.robots = {kHostile};
  kept.tracks[0].robot = kHostile;
  kept.history.attention = {{1000, true, kHostile}};
  return kept;
}

std::vector<api::ReportDetail> hostile_reports() {
  api::ReportDetail report;
  report.row.number = 7;
  report.row.type = report.row.note = kHostile;
  report.row.robot = "robot1";
  report.row.state = "answered";
  report.row.score_change = 1;
  report.history = {{1000, "answered", kHostile}};
  return {report};
}

TEST(RunReport, ShowsScoreReportsMapRobotsAndAlarms) {
  const std::string html = run_report(hostile_run(), hostile_reports());
  for (const char* part :
       {"<dt>Score</dt><dd>5</dd>", "Reports", "<td>robot1</td>", "answered", "+1",
        "data:image/png;base64,iVBOR", ">Covered area (m\u00b2)</text>", "<dd>512 m\u00b2</dd>", "Robots",
        "Alarms that needed the operator", "1970-01-01 00:16:40"})
    EXPECT_THAT(html, HasSubstr(part));
}

TEST(RunReport, EscapesHostileNamesAndNotes) {
  const std::string html = run_report(hostile_run(), hostile_reports());
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("alert('")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt;&quot;&amp;\uFFFD"));
  EXPECT_THAT(html, Not(HasSubstr("href=\"http")));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
}

TEST(RunReport, DrawsChosenColoursAndDistinctLines) {
  api::KeptRun kept{{}, picture::Mosaic(), {}, {}, {}};
  for (const char* robot : {"r1", "r2", "r3", "r4"})
    kept.tracks.push_back({robot, {{1000.0 + static_cast<double>(kept.tracks.size()), {}, 0}}});
  kept.colours = {{"r2", 3}, {"r4", 3}, {"r3", 1}};
  std::string drawn = drawn_map(kept, {});
  const std::regex line(R"re(<polyline class="track" stroke="(#\w+)" stroke-dasharray="([^"]+)")re");
  std::vector<std::string> lines;
  for (std::sregex_iterator at(drawn.begin(), drawn.end(), line), end; at != end; ++at)
    lines.push_back((*at)[1].str() + " " + (*at)[2].str());
  // r1 has the second colour, because the first one is r3's. tests/page/robot_colour.test.js reads this case.
  EXPECT_THAT(lines, testing::ElementsAre("#025447 2.4 1.2", "#6b56a3 0.6 0.9", "#9e4930 none",
                                          "#6b56a3 2.7 0.9 0.6 0.9"));
}

TEST(RunReport, DrawsFortyRobotsDifferently) {
  api::KeptRun kept{{}, picture::Mosaic(), {}, {}, {}};
  for (int i = 0; i < 40; ++i) kept.tracks.push_back({"r" + std::to_string(i), {{1000.0 + i, {}, 0}}});
  const std::string drawn = drawn_map(kept, {});
  const std::regex line(R"re(<polyline class="track" stroke="(#\w+)")re");
  std::set<std::string> colours;
  for (std::sregex_iterator at(drawn.begin(), drawn.end(), line), end; at != end; ++at)
    colours.insert((*at)[1]);
  EXPECT_EQ(colours.size(), 40U);
}

TEST(RunReport, SortsRobotsByTheNumbersInTheirNames) {
  api::KeptRun kept{{}, picture::Mosaic(), {}, {}, {}};
  kept.facts.robots = {"r10", "r2", "r1"};
  const std::string html = run_report(kept, {});
  EXPECT_LT(html.find("<td>r1</td>"), html.find("<td>r2</td>"));
  EXPECT_LT(html.find("<td>r2</td>"), html.find("<td>r10</td>"));
}

TEST(RunReport, IsCompleteForAnEmptyRun) {
  const std::string html = run_report({{}, picture::Mosaic(), {}, {}}, {});
  EXPECT_THAT(html, HasSubstr("No reports."));
  EXPECT_THAT(html, HasSubstr("No map, track or place of a report is stored."));
  EXPECT_THAT(html, testing::EndsWith("</html>\n"));
}

TEST(RunReport, WritesTrueMinusSigns) {
  api::KeptRun kept = hostile_run();
  kept.facts.score = -5;
  api::ReportDetail report = hostile_reports().front();
  report.row.score_change = -1;
  report.row.position = icd::Point{.x = -1, .y = 2, .z = -3};
  const std::string html = run_report(kept, {report});
  for (const char* part : {"<dt>Score</dt><dd>\u22125</dd>", ">\u22121</td>", "\u22121.00, 2.00, \u22123.00"})
    EXPECT_THAT(html, HasSubstr(part));
}

api::ReportDetail report_at(std::int64_t number, double x, double y, std::int64_t score = 0) {
  api::ReportDetail report;
  report.row.number = number;
  report.row.type = "Drill";
  report.row.state = "answered";
  report.row.position = icd::Point{x, y, 0};
  report.row.score_change = score;
  return report;
}

TEST(RunReport, JoinsReportsAtOnePlaceIntoOneSign) {
  const api::KeptRun run{{}, picture::Mosaic(), {}, {}};
  const std::string map = drawn_map(
      run, {report_at(1, 0, 0), report_at(2, 0.1, 0, 1), report_at(3, 0, 0.1), report_at(4, 100, 50)});
  EXPECT_THAT(map, HasSubstr("<title>1 Drill, 2 Drill, 3 Drill</title><circle class=\"scored\""));
  EXPECT_THAT(map, HasSubstr(">3</text></g>"));
  EXPECT_THAT(map, HasSubstr("<title>4 Drill</title><rect class=\"report\""));
  EXPECT_THAT(map, HasSubstr(">4 Drill</text>"));
}

TEST(RunReport, TellsIfARobotHasNoGrid) {
  ARun run;
  run.easel.draw(picture::cloud_of({{1, 1, 0}, {2, 2, 0}}));
  const std::string html = run_report({run.facts, std::move(run.easel.mosaic), run.tracks, {}}, {});
  EXPECT_THAT(html, HasSubstr("<td>cloud</td><td class=\"n\">no grid</td>"));
  EXPECT_THAT(html, HasSubstr("<dt>Covered area</dt><dd>no grid</dd>"));
}

TEST(RunReport, TellsIfAMapNeverArrived) {
  ARun run;
  api::KeptRun kept{run.facts, picture::Mosaic(), run.tracks, {.at = {1000, 1002}}};
  kept.history.robots = {{"ugv1", {std::nullopt, std::nullopt}}};
  kept.history.sent_mbit = {0, 0};
  kept.history.queued_bytes = {0, 0};
  kept.history.scoring_ms = kept.history.mapping_ms = {{}, {}};
  EXPECT_THAT(run_report(kept, {}), HasSubstr("<td class=\"n\">never there</td>"));
}

TEST(RunReport, StaysSmallForALargeMap) {
  ARun run;
  run.draw(100);
  const api::KeptRun kept{run.facts, std::move(run.easel.mosaic), {}, {}};
  EXPECT_LT(run_report(kept, {}).size(), std::size_t{5} << 20);
}

TEST(Html, OmitsInvalidTimesAndNumbers) {
  EXPECT_EQ(duration_text(3723), "1:02:03");
  EXPECT_EQ(duration_text(-1), "-");
  EXPECT_EQ(to_fixed(1.0 / 0.0, 1), "-");
}

}  // namespace
}  // namespace adit::archive
