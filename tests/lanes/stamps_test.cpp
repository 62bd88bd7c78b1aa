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

TEST(StampShift, StartsAnewWhereAClockJumpedBackward) {
  StampShift shift;
  shift.shift("R1", 100.0, kNow);
  EXPECT_THAT(shift.shift("R1", 95.5, kNow + 1), DoubleNear(kNow - 4.5, 1e-6)) << "late, no jump";
  EXPECT_EQ(shift.shift("R1", 94.5, kNow + 1), kNow + 1);
  EXPECT_THAT(shift.shift("R1", 95.0, kNow + 2), DoubleNear(kNow + 1.5, 1e-6));
}

TEST(StampShift, StartsAnewWhereAClockJumpedAhead) {
  StampShift shift;
  shift.shift("R1", 100.0, kNow);
  EXPECT_THAT(shift.shift("R1", 104.5, kNow), DoubleNear(kNow + 4.5, 1e-6)) << "no jump";
  EXPECT_EQ(shift.shift("R1", 3600.0, kNow + 1), kNow + 1);
  EXPECT_THAT(shift.shift("R1", 3601.0, kNow + 2), DoubleNear(kNow + 2, 1e-6));
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
  EXPECT_EQ(shift.shift("silent", 100.5, kNow + 3), kNow + 3) << "begun anew";
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
