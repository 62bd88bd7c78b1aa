#include "forward/status_cache.hpp"

#include <gtest/gtest.h>

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

TEST(StatusCache, IsFreshForOneSecondAndUsableForFifteen) {
  StatusCache known;
  known.heard("{\"score\": 1}", {}, at(0), 0);
  EXPECT_TRUE(known.is_fresh(at(999)));
  EXPECT_FALSE(known.is_fresh(at(1000)));
  EXPECT_TRUE(known.answer(at(15'000)));
  EXPECT_FALSE(known.answer(at(15'001)));
}

TEST(StatusCache, IsUsableForAMinuteWhileReportsGoFirst) {
  StatusCache known;
  known.heard("{}", {}, at(0), 0);
  EXPECT_TRUE(known.answer(at(60'000), StatusCache::kOldestBehindReports));
  EXPECT_FALSE(known.answer(at(60'001), StatusCache::kOldestBehindReports));
}

TEST(StatusCache, HasAnAgeInWholeSeconds) {
  StatusCache known;
  known.heard("{\"score\": 1}", {}, at(0), 0);
  const std::pair<int, const char*> cases[] = {{0, "0"}, {999, "0"}, {1000, "1"}, {14'999, "14"}};
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
  known.heard("{}", {}, at(0), 0);
  known.no_longer_fresh();
  EXPECT_FALSE(known.is_fresh(at(1)));
  EXPECT_TRUE(known.answer(at(1)));
  known.heard("{}", {}, at(2), 0);
  EXPECT_TRUE(known.is_fresh(at(3)));
}

}  // namespace
}  // namespace adit::forward
