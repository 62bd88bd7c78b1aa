#include "dispatch/turn.hpp"

#include <gtest/gtest.h>

#include <array>

namespace adit::dispatch {
namespace {

using std::chrono::milliseconds;

Instant at(int ms) {
  return Instant{} + milliseconds(ms);
}

TEST(Turn, BelongsToTheOldestNewsThatMayBeSent) {
  const std::array candidates = {Candidate{at(50), at(0)}, Candidate{at(10), at(0)},
                                 Candidate{at(5), at(500)}};
  const Turn turn = oldest_first(candidates, at(100));
  EXPECT_EQ(turn.candidate, 1u);
  EXPECT_FALSE(turn.wake);
}

TEST(Turn, ComesWithTheFirstRateLimitThatEnds) {
  const std::array candidates = {Candidate{at(50), at(900)}, Candidate{at(60), at(300)},
                                 Candidate{std::nullopt, at(0)}};
  const Turn turn = oldest_first(candidates, at(100));
  EXPECT_FALSE(turn.candidate);
  EXPECT_EQ(turn.wake, at(300));
}

TEST(Turn, IsNobodysWithoutNews) {
  const std::array candidates = {Candidate{std::nullopt, at(0)}, Candidate{std::nullopt, at(0)}};
  EXPECT_FALSE(oldest_first(candidates, at(1)).candidate);
  EXPECT_FALSE(oldest_first(candidates, at(1)).wake);
  EXPECT_FALSE(in_order(candidates, at(1)).candidate);
}

TEST(Turn, OfAStatusWaitsForAReportThatMayNotBeSentYet) {
  const std::array candidates = {Candidate{at(50), at(900)}, Candidate{at(10), at(0)}};
  const Turn turn = in_order(candidates, at(100));
  EXPECT_FALSE(turn.candidate);
  EXPECT_EQ(turn.wake, at(900));
}

TEST(Turn, GoesInOrderWhereAllMaySend) {
  const std::array candidates = {Candidate{at(50), at(0)}, Candidate{at(10), at(0)}};
  EXPECT_EQ(in_order(candidates, at(100)).candidate, 0u);
}

}  // namespace
}  // namespace adit::dispatch
