#include <gmock/gmock.h>

#include <numeric>

#include "archive/run_records.hpp"

namespace adit::archive {
namespace {

using testing::ElementsAre;

TEST(Samples, HaveListsOfOneLength) {
  Samples samples;
  samples.add(Sample{.at = 10, .sent_mbit = 1, .map_ages = {{"a", 3}}});
  samples.add(Sample{.at = 12, .sent_mbit = 2, .scoring_ms = 9, .map_ages = {{"b", 1}}});
  const api::History all = samples.history_after(0);
  EXPECT_THAT(all.at, ElementsAre(10, 12));
  EXPECT_THAT(all.scoring_ms, ElementsAre(std::nullopt, 9));
  ASSERT_EQ(all.robots.size(), 2U);
  EXPECT_THAT(all.robots[0].ages, ElementsAre(3, std::nullopt));
  EXPECT_THAT(samples.history_after(10).at, ElementsAre(12));
}

TEST(Samples, AreDueEachTwoSecondsAndNeverBackInTime) {
  Samples samples;
  EXPECT_TRUE(samples.is_due(10));
  samples.add(Sample{.at = 10});
  EXPECT_FALSE(samples.is_due(11));
  EXPECT_TRUE(samples.is_due(11.9));
  samples.add(Sample{.at = 5});
  EXPECT_THAT(samples.history_after(0).at, ElementsAre(10));
}

TEST(Samples, AreThinnedEvenlyAndKeepEach429) {
  Samples samples;
  constexpr int kMany = 20'000;
  for (int i = 0; i < kMany; ++i) samples.add(Sample{.at = 2.0 * (i + 1), .throttled = 1});
  const api::History all = samples.history_after(0);
  EXPECT_LE(all.at.size(), Samples::kMost);
  EXPECT_GE(all.at.size(), Samples::kMost / 2);
  EXPECT_EQ(std::accumulate(all.throttled.begin(), all.throttled.end(), std::uint64_t{0}), kMany);
  EXPECT_EQ(all.at.front(), 2);
  EXPECT_GT(all.spacing, Samples::kSpacing);
}

TEST(Attention, IsRecordedAtItsStartAndEnd) {
  Attention attention;
  EXPECT_EQ(attention.update({"a", "b"}, 1).size(), 2U);
  EXPECT_TRUE(attention.update({"b", "a"}, 2).empty());
  const auto steps = attention.update({"b", "c"}, 3);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_FALSE(steps[0].came);
  EXPECT_EQ(steps[0].sentence, "a");
  EXPECT_TRUE(steps[1].came);
  EXPECT_EQ(steps[1].at, 3);
}

TEST(Attention, OfAnEarlierProcessEndsAfterARestart) {
  Attention attention;
  attention.restore({{1, true, "a"}, {2, true, "b"}, {3, false, "a"}});
  const auto steps = attention.update({}, 4);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].sentence, "b");
}

TEST(Samples, ContinueAfterAClockStepBack) {
  Samples samples;
  samples.add(Sample{.at = 100});
  samples.add(api::AttentionStep{100, true, "it"});
  samples.move(-50);
  EXPECT_TRUE(samples.is_due(52));
  samples.add(Sample{.at = 52});
  EXPECT_THAT(samples.history_after(0).at, ElementsAre(50, 52));
  EXPECT_EQ(samples.history_after(0).attention.front().at, 50);
}

}  // namespace
}  // namespace adit::archive
