#include <gtest/gtest.h>

#include <array>

#include "pace/rate_limit.hpp"

namespace adit::pace {
namespace {

using std::chrono::milliseconds;

Instant at_ms(int ms) {
  return Instant{} + milliseconds(ms);
}

TEST(Turn, BelongsToTheOldestMessageThatMayBeSent) {
  const std::array candidates = {Candidate{at_ms(50), at_ms(0)}, Candidate{at_ms(10), at_ms(0)},
                                 Candidate{at_ms(5), at_ms(500)}};
  const Turn turn = oldest_first(candidates, at_ms(100));
  EXPECT_EQ(turn.candidate, 1u);
  EXPECT_FALSE(turn.wake);
}

TEST(Turn, ComesWhenTheFirstRateLimitEnds) {
  const std::array candidates = {Candidate{at_ms(50), at_ms(900)}, Candidate{at_ms(60), at_ms(300)},
                                 Candidate{std::nullopt, at_ms(0)}};
  const Turn turn = oldest_first(candidates, at_ms(100));
  EXPECT_FALSE(turn.candidate);
  EXPECT_EQ(turn.wake, at_ms(300));
}

TEST(Turn, IsVacantWithoutMessages) {
  const std::array candidates = {Candidate{std::nullopt, at_ms(0)}, Candidate{std::nullopt, at_ms(0)}};
  EXPECT_FALSE(oldest_first(candidates, at_ms(1)).candidate);
  EXPECT_FALSE(oldest_first(candidates, at_ms(1)).wake);
  EXPECT_FALSE(first_ready(candidates, at_ms(1)).candidate);
}

TEST(Turn, OfAStatusComesAfterAPendingReport) {
  const std::array candidates = {Candidate{at_ms(50), at_ms(900)}, Candidate{at_ms(10), at_ms(0)}};
  const Turn turn = first_ready(candidates, at_ms(100));
  EXPECT_FALSE(turn.candidate);
  EXPECT_EQ(turn.wake, at_ms(900));
}

TEST(Turn, FollowsTheOrderIfAllMaySend) {
  const std::array candidates = {Candidate{at_ms(50), at_ms(0)}, Candidate{at_ms(10), at_ms(0)}};
  EXPECT_EQ(first_ready(candidates, at_ms(100)).candidate, 0u);
}

}  // namespace
}  // namespace adit::pace
