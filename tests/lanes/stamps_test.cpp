#include "lanes/stamps.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>
#include <string>

namespace adit::lanes {
namespace {

using testing::DoubleNear;

constexpr double kNow = 1'650'000'000;

TEST(StampShift, TakesTheFirstStampAsNowAndKeepsTheSpacingFromThenOn) {
  StampShift shift;
  EXPECT_EQ(shift.shift("R1", 100.0, kNow), kNow);
  EXPECT_THAT(shift.shift("R1", 100.3, kNow + 2), DoubleNear(kNow + 0.3, 1e-6)) << "however late it came";
  EXPECT_THAT(shift.shift("R1", 100.1, kNow + 2), DoubleNear(kNow + 0.1, 1e-6)) << "out of order";
}

TEST(StampShift, StampsWhatHasNoStampWithNow) {
  StampShift shift;
  EXPECT_EQ(shift.shift("R1", {}, kNow), kNow);
  EXPECT_EQ(shift.shift("R1", 0.0, kNow + 1), kNow + 1) << "ROS: not set";
  EXPECT_EQ(shift.shift("R1", 100.0, kNow + 2), kNow + 2) << "the first that it gave";
}

TEST(StampShift, PutsWhatHasNoStampNotBeforeWhatItsSenderStampedLast) {
  StampShift shift;
  shift.shift("R1", 100.0, kNow);
  const icd::Stamp ahead = shift.shift("R1", 104.0, kNow + 1);
  EXPECT_EQ(shift.shift("R1", {}, kNow + 1), ahead);
  EXPECT_EQ(shift.shift("R1", {}, kNow + 9), kNow + 9);
}

TEST(StampShift, KeepsSendersApart) {
  StampShift shift;
  EXPECT_EQ(shift.shift("R1", 100.0, kNow), kNow);
  EXPECT_EQ(shift.shift("R2", 9000.0, kNow + 1), kNow + 1);
  EXPECT_THAT(shift.shift("R1", 101.5, kNow + 2), DoubleNear(kNow + 1.5, 1e-6));
}

TEST(StampShift, StartsAgainWhereAClockJumpedBackward) {
  StampShift shift;
  shift.shift("R1", 100.0, kNow);
  EXPECT_THAT(shift.shift("R1", 95.5, kNow + 1), DoubleNear(kNow - 4.5, 1e-6)) << "late, no jump";
  EXPECT_EQ(shift.shift("R1", 94.5, kNow + 1), kNow + 1);
  EXPECT_THAT(shift.shift("R1", 95.0, kNow + 2), DoubleNear(kNow + 1.5, 1e-6));
}

TEST(StampShift, StartsAgainWhereAClockJumpedAhead) {
  StampShift shift;
  shift.shift("R1", 100.0, kNow);
  EXPECT_THAT(shift.shift("R1", 104.5, kNow), DoubleNear(kNow + 4.5, 1e-6)) << "no jump";
  EXPECT_THAT(shift.shift("R1", 3600.0, kNow + 1), DoubleNear(kNow + 4.5, 1e-6)) << "nor behind what it had";
  EXPECT_THAT(shift.shift("R1", 3601.0, kNow + 2), DoubleNear(kNow + 5.5, 1e-6));
  EXPECT_EQ(shift.shift("R1", 9000.0, kNow + 60), kNow + 60);
}

TEST(StampShift, PutsWhatAClockSaysAfterItWasSetBackBehindNothingThatItHasSaid) {
  for (const double back : {2.0, 3.5, 4.9, 5.1, 3600.0}) {
    SCOPED_TRACE(back);
    StampShift shift;
    shift.shift("R1", 10'000.0, kNow, 1);
    const icd::Stamp ahead = shift.shift("R1", 10'004.0, kNow + 0.1, 1);
    const icd::Stamp first = shift.shift("R1", 10'004.1 - back, kNow + 0.2, 1);
    EXPECT_GE(first, ahead) << "its pose counts at once";
    EXPECT_THAT(shift.shift("R1", 10'004.4 - back, kNow + 0.3, 1), DoubleNear(first + 0.3, 1e-6));
  }
}

TEST(StampShift, KeepsTheSpacingOfStampsOfAnySize) {
  StampShift shift;
  EXPECT_EQ(shift.shift("R1", 1e308, kNow), kNow);
  EXPECT_EQ(shift.shift("R1", 1e308, kNow + 1), kNow);
  EXPECT_EQ(shift.shift("R1", std::numeric_limits<double>::max(), kNow + 1), kNow + 1);
  EXPECT_EQ(shift.shift("R1", std::numeric_limits<double>::denorm_min(), kNow + 2), kNow + 2);
}

TEST(StampShift, IsNeverNegativeNorFarAheadOfNow) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> any{0, 60};
  StampShift shift;
  for (int i = 0; i < 2000; ++i) {
    const double now = i * 0.1;
    const auto stamp = shift.shift("R1", any(random), now);
    ASSERT_GE(stamp, 0);
    ASSERT_LE(stamp, now + StampShift::kJump);
  }
}

TEST(StampShift, ForgetsTheSenderThatWasSilentLongest) {
  StampShift shift;
  shift.shift("silent", 100.0, kNow);
  shift.shift("busy", 100.0, kNow);
  for (std::size_t i = 0; i < StampShift::kMostSenders; ++i) {
    shift.shift("hostile" + std::to_string(i), 5.0, kNow);
    shift.shift("busy", 100.0, kNow);
  }
  EXPECT_THAT(shift.shift("busy", 100.5, kNow + 3), DoubleNear(kNow + 0.5, 1e-6));
  EXPECT_EQ(shift.shift("silent", 100.5, kNow + 3), kNow + 3) << "restarted";
}

/// As one life hands over to the next, at any message: nobody can see that it did.
TEST(StampShift, GoesOnInTheNextLifeAsIfNothingHadBeen) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> step{-6, 4};
  StampShift uninterrupted, living;
  double theirs = 9000;
  for (int i = 0; i < 3000; ++i) {
    const double now = kNow + i * 0.5;
    const std::string sender = "R" + std::to_string(i % 3);
    theirs = std::max(0.0, theirs + step(random) + 1.2);
    ASSERT_EQ(living.shift(sender, theirs, now), uninterrupted.shift(sender, theirs, now)) << i;
    StampShift next;
    for (const auto& [each, clock] : living.clocks()) next.carry_on(each, clock);
    living = std::move(next);
  }
}

TEST(StampShift, KnowsWhatTheClockOfARobotShowsThatSpeaksForAWhile) {
  StampShift shift;
  EXPECT_FALSE(shift.told(kNow, 0, 1e9));
  for (int second = 0; second <= 9; ++second) shift.shift("R1", 5000.0 + second, kNow + second);
  EXPECT_FALSE(shift.told(kNow + 9, 0, 1e9));
  shift.shift("R1", 5010.0, kNow + 10);
  EXPECT_THAT(*shift.told(kNow + 12, 0, 1e9), DoubleNear(5012, 1e-6));
  for (int second = 0; second <= 10; ++second) shift.shift("R2", 100.0 + second, kNow + second);
  EXPECT_THAT(*shift.told(kNow + 12, 0, 1e9), DoubleNear(112, 1e-6)) << "the earliest";
  EXPECT_THAT(*shift.told(kNow + 12, 1000, 1e9), DoubleNear(5012, 1e-6)) << "the other one's is not set";
  EXPECT_THAT(*shift.told(kNow + 12, 0, 1000), DoubleNear(112, 1e-6));
  EXPECT_FALSE(shift.told(kNow + 21, 0, 1e9)) << "they say nothing any more";
}

TEST(StampShift, ForgetsInTheNextLifeTheOneThatWasSilentLongest) {
  StampShift shift;
  for (std::size_t i = 0; i < StampShift::kMostSenders; ++i) shift.shift(std::to_string(i), 5.0, kNow);
  shift.shift("0", 5.5, kNow);
  StampShift next;
  for (const auto& [sender, clock] : shift.clocks()) next.carry_on(sender, clock);
  next.shift("new", 5.0, kNow + 9);
  EXPECT_NE(next.clock_of("0"), nullptr);
  EXPECT_EQ(next.clock_of("1"), nullptr);
}

TEST(StampOrder, GoesOnFromTheLastOfAnEarlierLife) {
  StampOrder order;
  order.carry_on(10);
  EXPECT_EQ(order.next(9), 10);
  order.carry_on(8);
  EXPECT_EQ(order.next(9.5), 10);
}

TEST(StampOrder, NeverRunsBackward) {
  StampOrder order;
  EXPECT_EQ(order.next(10), 10);
  EXPECT_EQ(order.next(10.5), 10.5);
  EXPECT_EQ(order.next(9), 10.5);
  EXPECT_EQ(order.next(10.6), 10.6);
}

}  // namespace
}  // namespace adit::lanes
