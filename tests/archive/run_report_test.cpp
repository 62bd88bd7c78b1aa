#include "archive/run_report.hpp"

#include <gmock/gmock.h>

#include <regex>

#include "archive/a_run.hpp"
#include "archive/html.hpp"

namespace adit::archive {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kHostile = "<script>alert('1')</script>\"&\x01";

api::KeptRun hostile_run() {
  ARun run;
  run.draw(2);
  api::KeptRun kept{run.facts, std::move(run.easel.mosaic), run.tracks, {}, {{1000, 5}, {1010, 64}}};
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

TEST(RunReport, SaysScoreReportsMapCoverageRobotsAndWhatNeededTheOperator) {
  const std::string html = run_report(hostile_run(), hostile_reports());
  for (const char* part : {"<dt>Score</dt><dd>5</dd>", "Reports", "<td>robot1</td>", "answered", "+1",
                           "data:image/png;base64,iVBOR", "Coverage over time", "64 m", "Robots",
                           "Alarms that needed the operator", "1970-01-01 00:16:40"})
    EXPECT_THAT(html, HasSubstr(part));
}

TEST(RunReport, IsNothingButWhatItSaysWhateverNamesAndNotesHold) {
  const std::string html = run_report(hostile_run(), hostile_reports());
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("alert('")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt;&quot;&amp;\uFFFD"));
  EXPECT_THAT(html, Not(HasSubstr("href=\"http")));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
}

TEST(RunReport, DrawsChosenColoursAndTellsRobotsOfOneColourApartByTheirLines) {
  api::KeptRun kept{{}, picture::Mosaic(), {}, {}, {}};
  for (const char* robot : {"r1", "r2", "r3", "r4"})
    kept.tracks.push_back({robot, {{1000.0 + static_cast<double>(kept.tracks.size()), {}, 0}}});
  kept.colours = {{"r2", 3}, {"r4", 3}, {"r3", 1}};
  std::string drawn = drawn_map(kept, {});
  const std::regex line(R"re(stroke="(#\w+)" stroke-width="[^"]+" stroke-dasharray="([\d.]+))re");
  std::vector<std::string> lines;
  for (std::sregex_iterator at(drawn.begin(), drawn.end(), line), end; at != end; ++at)
    lines.push_back((*at)[1].str() + " " + (*at)[2].str());
  // the second colour, because the first one is r3's
  EXPECT_THAT(lines,
              testing::ElementsAre("#025447 0.016", "#6b56a3 0.004", "#9e4930 4000.000", "#6b56a3 0.018"));
}

TEST(RunReport, OfARunOfWhichNothingIsKnownIsWhole) {
  const std::string html = run_report({{}, picture::Mosaic(), {}, {}, {}}, {});
  EXPECT_THAT(html, HasSubstr("No reports."));
  EXPECT_THAT(html, HasSubstr("No map is stored."));
  EXPECT_THAT(html, testing::EndsWith("</html>\n"));
}

TEST(RunReport, StaysSmallHoweverMuchWasMapped) {
  ARun run;
  run.draw(100);
  const api::KeptRun kept{run.facts, std::move(run.easel.mosaic), {}, {}, {}};
  EXPECT_LT(run_report(kept, {}).size(), std::size_t{5} << 20);
}

TEST(Html, TimesAndNumbersAreFiniteOrNotThere) {
  EXPECT_EQ(lasted(3723), "1:02:03");
  EXPECT_EQ(lasted(-1), "-");
  EXPECT_EQ(fixed(1.0 / 0.0, 1), "-");
}

}  // namespace
}  // namespace adit::archive
