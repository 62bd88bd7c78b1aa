#include <gtest/gtest.h>

#include "forward/scoring.hpp"

namespace adit::forward {
namespace {

using std::chrono::milliseconds;

loop::Instant at(int ms) {
  return loop::Instant{} + milliseconds(1'000'000 + ms);
}

TEST(StatusCache, IsEmptyAtFirst) {
  const StatusCache known;
  EXPECT_FALSE(known.is_fresh(at(0)));
  EXPECT_FALSE(known.answer(at(0)));
}

TEST(StatusCache, IsFreshForOneSecondAndUsableForAMinute) {
  StatusCache known;
  known.on_status("{\"score\": 1}", {}, at(0), 0);
  EXPECT_TRUE(known.is_fresh(at(999)));
  EXPECT_FALSE(known.is_fresh(at(1000)));
  EXPECT_TRUE(known.answer(at(60'000)));
  EXPECT_FALSE(known.answer(at(60'001)));
}

TEST(StatusCache, HasAnAgeInWholeSeconds) {
  StatusCache known;
  known.on_status("{\"score\": 1}", {}, at(0), 0);
  const std::pair<int, const char*> cases[] = {{0, "0"}, {999, "0"}, {1000, "1"}, {59'999, "59"}};
  for (const auto& [ms, age] : cases) {
    const auto answer = known.answer(at(ms));
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body, "{\"score\": 1}");
    ASSERT_EQ(answer->headers.size(), 1);
    EXPECT_EQ(answer->headers.front().name, "Age");
    EXPECT_EQ(answer->headers.front().value, age);
  }
}

TEST(StatusCache, IsUsableAfterItMayHaveChanged) {
  StatusCache known;
  known.on_status("{}", {}, at(0), 0);
  known.mark_stale();
  EXPECT_FALSE(known.is_fresh(at(1)));
  EXPECT_TRUE(known.answer(at(1)));
  known.on_status("{}", {}, at(2), 0);
  EXPECT_TRUE(known.is_fresh(at(3)));
}

std::string told(const StatusCache& known, int ms) {
  const auto answer = known.answer(at(ms));
  return answer ? answer->body : "none";
}

TEST(StatusCache, HasTheEffectOfReportsThatWereAnsweredSince) {
  StatusCache known;
  known.on_status(R"({"score": 3, "run_clock": 100.5, "remaining_reports": 20, "current_team": "a"})",
                  {.score = 3, .run_clock = 100.5, .remaining_reports = 20, .current_team = "a"}, at(0), 0);
  known.add_report({.scored = true, .points = 1}, 101.5, at(1000));
  EXPECT_EQ(told(known, 1500), R"({"score":4,"run_clock":101.5,"remaining_reports":19,"current_team":"a"})");
  known.add_report({.scored = true, .points = 0}, 102.5, at(2000));
  known.add_report({.again = true}, 103.5, at(3000));
  EXPECT_EQ(told(known, 3500), R"({"score":4,"run_clock":103.5,"remaining_reports":18,"current_team":"a"})");
  EXPECT_EQ(known.answer(at(3500))->headers.front().value, "3") << "the age of the Command Post's status";
  EXPECT_EQ(known.run()->score, 3) << "as it came";
  known.on_status(R"({"score": 4, "remaining_reports": 18})", {}, at(4000), 0);
  EXPECT_EQ(told(known, 4000), R"({"score": 4, "remaining_reports": 18})");
}

TEST(StatusCache, KeepsItsFormWithTheEffectOfReports) {
  StatusCache known;
  known.on_status(R"({"team": {"name": "b"}, "clock": 5, "remaining_reports": 2, "score": 0})",
                  {.score = 0, .run_clock = 5, .remaining_reports = 2, .current_team = ""}, at(0), 0);
  known.add_report({.scored = true, .points = 1}, 6, at(1000));
  EXPECT_EQ(told(known, 1000), R"({"team":{"name":"b"},"clock":6.0,"remaining_reports":1,"score":1})");
}

/// The measured server's status and its answers have different clocks, which stand.
TEST(StatusCache, HasNoClockOfAnotherUri) {
  for (const double clock : {3.14, 0.0, 28.0}) {
    StatusCache known;
    known.on_status(R"({"score":0,"run_clock":25.98,"remaining_reports":2})",
                    {.score = 0, .run_clock = 25.98, .remaining_reports = 2, .current_team = ""}, at(0), 0);
    known.add_report({.scored = true, .points = 1}, clock, at(1000));
    EXPECT_EQ(told(known, 1000), R"({"score":1,"run_clock":25.98,"remaining_reports":1})") << clock;
  }
}

TEST(StatusCache, IsNoAnswerWithReportsAlone) {
  StatusCache known;
  known.add_report({.scored = true, .points = 1}, 5, at(0));
  EXPECT_EQ(told(known, 0), "none");
}

}  // namespace
}  // namespace adit::forward
