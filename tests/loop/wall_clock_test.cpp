#include <gtest/gtest.h>

#include "loop/loop.hpp"

namespace adit::loop {
namespace {

using std::chrono::milliseconds;

constexpr double kBegan = 1.7e9;

class WallClockTest : public testing::Test {
 protected:
  /// Checks the clock after a second of monotonic time, in which the system's clock advances by `seconds`.
  double update(double seconds = 1, bool is_right = false) {
    at_ += milliseconds(1000);
    system_ += seconds;
    return clock_.update(system_, at_, is_right);
  }
  double now() const { return clock_.now(at_); }

  WallClock::Instant at_{};
  double system_ = kBegan;
  WallClock clock_{system_, at_};
};

TEST_F(WallClockTest, FollowsTheSystemDespiteReadJitter) {
  EXPECT_EQ(update(1.004), 0);
  EXPECT_DOUBLE_EQ(now(), kBegan + 1);
  EXPECT_EQ(update(0.996), 0);
  EXPECT_DOUBLE_EQ(now(), kBegan + 2);
}

TEST_F(WallClockTest, ReportsASmallStep) {
  EXPECT_NEAR(update(1 + 0.3), 0.3, 1e-6) << "the clock must follow, or earlier times seem too old";
  EXPECT_DOUBLE_EQ(now(), kBegan + 1.3);
  EXPECT_NEAR(update(1 - 0.4), -0.4, 1e-6);
  EXPECT_DOUBLE_EQ(now(), kBegan + 1.9);
}

TEST_F(WallClockTest, AccumulatesTinySteps) {
  for (int i = 0; i < 2; ++i) EXPECT_EQ(update(1.004), 0);
  EXPECT_NEAR(update(1.004), 0.012, 1e-6);
  EXPECT_DOUBLE_EQ(now(), kBegan + 3.012);
}

TEST_F(WallClockTest, ReportsTheSizeOfAStep) {
  EXPECT_DOUBLE_EQ(update(1 + 3600), 3600);
  EXPECT_DOUBLE_EQ(now(), kBegan + 3601);
  EXPECT_DOUBLE_EQ(update(1 - 86400), -86400);
  EXPECT_EQ(update(), 0);
}

TEST_F(WallClockTest, StaysSteadyBetweenTwoReads) {
  update();
  system_ += 3600;
  EXPECT_DOUBLE_EQ(clock_.now(at_ + milliseconds(500)), kBegan + 1.5);
}

TEST_F(WallClockTest, IsAheadOfALateSystemUntilThatIsSet) {
  clock_.set(kBegan + 5000, at_);
  EXPECT_DOUBLE_EQ(now(), kBegan + 5000);
  EXPECT_EQ(update(), 0);
  EXPECT_DOUBLE_EQ(now(), kBegan + 5001);
  EXPECT_NEAR(update(1 + 5000), 0, 1e-6) << "the clock returned to the known time";
  EXPECT_DOUBLE_EQ(now(), kBegan + 5002);
  EXPECT_DOUBLE_EQ(update(1 + 60), 60);
}

TEST_F(WallClockTest, ReportsTheDifferenceFromTheKnownTime) {
  clock_.set(kBegan + 5000, at_);
  EXPECT_DOUBLE_EQ(update(1 + 5060), 60);
}

TEST_F(WallClockTest, YieldsToASystemFoundRight) {
  clock_.set(kBegan + 5000, at_);
  EXPECT_NEAR(update(1.004, true), -5000, 0.01) << "the difference is too small for a step";
  EXPECT_DOUBLE_EQ(now(), kBegan + 1.004);
  EXPECT_EQ(update(0.996, true), 0);
}

}  // namespace
}  // namespace adit::loop
