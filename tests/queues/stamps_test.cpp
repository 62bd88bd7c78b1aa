#include "queues/stamps.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace adit::queues {
namespace {

using testing::DoubleNear;

constexpr double kNow = 1'650'000'000;

Stamper of(const std::string& robot, const std::string& address = "10.0.0.5") {
  return {address, icd::Uri::StateUpdate, robot};
}

TEST(StampShift, FirstStampIsNowAndSpacingIsKept) {
  StampShift shift;
  EXPECT_EQ(shift.shift(of("R1"), 100.0, kNow), kNow);
  EXPECT_THAT(shift.shift(of("R1"), 100.3, kNow + 2), DoubleNear(kNow + 0.3, 1e-6))
      << "a late message has its own stamp";
  EXPECT_THAT(shift.shift(of("R1"), 100.1, kNow + 2), DoubleNear(kNow + 0.1, 1e-6)) << "out of order";
}

TEST(StampShift, StampsUnstampedMessagesWithNow) {
  StampShift shift;
  EXPECT_EQ(shift.shift(of("R1"), {}, kNow), kNow);
  EXPECT_EQ(shift.shift(of("R1"), 0.0, kNow + 1), kNow + 1) << "ROS: not set";
  EXPECT_EQ(shift.shift(of("R1"), 100.0, kNow + 2), kNow + 2) << "the first stamp of this robot";
}

TEST(StampShift, StampsUnstampedMessagesNotBeforeTheLastStamp) {
  StampShift shift;
  shift.shift(of("R1"), 100.0, kNow);
  const icd::Stamp ahead = shift.shift(of("R1"), 104.0, kNow + 1);
  EXPECT_EQ(shift.shift(of("R1"), {}, kNow + 1), ahead);
  EXPECT_EQ(shift.shift(of("R1"), {}, kNow + 9), kNow + 9);
}

TEST(StampShift, KeepsSendersApart) {
  StampShift shift;
  EXPECT_EQ(shift.shift(of("R1"), 100.0, kNow), kNow);
  EXPECT_EQ(shift.shift(of("R2"), 9000.0, kNow + 1), kNow + 1);
  EXPECT_THAT(shift.shift(of("R1"), 101.5, kNow + 2), DoubleNear(kNow + 1.5, 1e-6));
}

/// Posts at 10 Hz for `seconds`, from `stamp` and `now`; the last converted stamp.
icd::Stamp run(StampShift& shift, double stamp, double now, double seconds) {
  icd::Stamp last = 0;
  for (int i = 0; i <= std::lround(seconds * 10); ++i)
    last = shift.shift(of("R1"), stamp + i * 0.1, now + i * 0.1);
  return last;
}

TEST(StampShift, RestartsIfAClockThatWasSetBackRunsOn) {
  for (const double back : {5.2, 60.0, 3599.0}) {
    SCOPED_TRACE(back);
    StampShift shift;
    run(shift, 10'000, kNow, 10);
    EXPECT_THAT(run(shift, 10'010.1 - back, kNow + 10.1, 4.9), DoubleNear(kNow + 15 - back, 1e-3))
        << "it may be a backlog";
    EXPECT_THAT(run(shift, 10'015.1 - back, kNow + 15.1, 1), DoubleNear(kNow + 16.1, 1e-3));
  }
}

TEST(StampShift, RestartsAtOnceIfAClockWasSetBackByHours) {
  StampShift shift;
  run(shift, 10'000, kNow, 10);
  EXPECT_THAT(shift.shift(of("R1"), 6409.9, kNow + 10.1), DoubleNear(kNow + 10.1, 1e-6));
}

TEST(StampShift, IsNotSetBackByABacklog) {
  const auto latest_after = [](auto&& post) {
    StampShift shift;
    run(shift, 10'000, kNow, 10);
    for (int i = 0; i < 400; ++i) post(shift, i);
    return shift.shift(of("R1"), 10'060, kNow + 60);
  };
  const auto older = [](StampShift& shift, double back, double after) {
    EXPECT_THAT(shift.shift(of("R1"), 10'010 - back, kNow + 10 + after), DoubleNear(kNow + 10 - back, 1e-3));
  };
  const auto is_unmoved = DoubleNear(kNow + 60, 1e-3);
  EXPECT_THAT(latest_after([&](auto& shift, int i) { older(shift, 405 - i, i * 0.1); }), is_unmoved)
      << "ten times as fast as time";
  EXPECT_THAT(latest_after([&](auto& shift, int i) { older(shift, 50 - i * 0.12, i * 0.08); }), is_unmoved)
      << "half as fast again as time";
  EXPECT_THAT(latest_after([&](auto& shift, int i) { older(shift, 10 + i * 0.1, i * 0.1); }), is_unmoved)
      << "the newest first";
  EXPECT_THAT(latest_after([&](auto& shift, int i) { older(shift, 10, i * 0.1); }), is_unmoved)
      << "one pose again and again";
  EXPECT_THAT(latest_after([&](auto& shift, int i) { older(shift, 20 - i % 2 * 8 - i * 0.01, i * 0.1); }),
              is_unmoved)
      << "two nodes with two old poses";
  EXPECT_THAT(latest_after([&](auto& shift, int i) {
                if (i % 20 == 0) shift.shift(of("R1"), 10'010 + i * 0.1, kNow + 10 + i * 0.1);
                older(shift, 50 - i * 0.1, i * 0.1);
              }),
              is_unmoved)
      << "as fast as time, beside the newest ones";
}

/// Each message may be up to 4 s late. Some wait for others.
TEST(StampShift, IsNotSetBackByASlowUpload) {
  StampShift shift;
  shift.shift(of("R1"), 10'000.0, kNow, {.began = 1, .ended = 2});
  shift.shift(of("R1"), 10'010.0, kNow + 10, {.began = 4, .ended = 5});
  shift.shift(of("R1"), 10'003.0, kNow + 11, {.began = 6, .ended = 7});  // of a backlog
  const Upload slow{.began = 3, .ended = 8};
  EXPECT_THAT(shift.shift(of("R1"), 10'009.5, kNow + 17, slow), DoubleNear(kNow + 9.5, 1e-6));
}

TEST(StampShift, RestartsAlthoughMessagesAreLate) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> late{0, 4};
  for (int robot = 0; robot < 100; ++robot) {
    StampShift shift;
    run(shift, 10'000, kNow, 10);
    double now = kNow + 10;
    icd::Stamp last = 0;
    for (int i = 0; i < 300; ++i) {
      now = std::max(now, kNow + 10 + i * 0.1 + (i % 10 == 0 ? late(random) : 0));
      last = shift.shift(of("R1"), 5000 + i * 0.1, now);
    }
    EXPECT_NEAR(last, now, 4.1) << robot;
  }
}

TEST(StampShift, RestartsAfterAClockStepAhead) {
  StampShift shift;
  shift.shift(of("R1"), 100.0, kNow);
  EXPECT_THAT(shift.shift(of("R1"), 104.5, kNow), DoubleNear(kNow + 4.5, 1e-6))
      << "the clock was not stepped";
  EXPECT_THAT(shift.shift(of("R1"), 3600.0, kNow + 1), DoubleNear(kNow + 4.5, 1e-6)) << "a stamp ran back";
  EXPECT_THAT(shift.shift(of("R1"), 3601.0, kNow + 2), DoubleNear(kNow + 5.5, 1e-6));
  EXPECT_EQ(shift.shift(of("R1"), 9000.0, kNow + 60), kNow + 60);
}

TEST(StampShift, ConvertsAMessageFromBeforeAStepAsBefore) {
  StampShift shift;
  const Upload slow{.began = 1, .ended = 6}, quick{.began = 2, .ended = 3}, stepped{.began = 4, .ended = 5};
  shift.shift(of("R1"), 9000.0, kNow, quick);
  EXPECT_THAT(shift.shift(of("R1"), 500.0, kNow + 2, stepped), DoubleNear(kNow + 2, 1e-6)) << "a step";
  EXPECT_THAT(shift.shift(of("R1"), 8999.5, kNow + 3, slow), DoubleNear(kNow - 0.5, 1e-6));
  EXPECT_THAT(shift.shift(of("R1"), 501.5, kNow + 4, {.began = 7, .ended = 8}), DoubleNear(kNow + 3.5, 1e-6))
      << "the step stands";
}

TEST(StampShift, OrdersMessagesThatCameBeforeAStepWasShown) {
  StampShift shift;
  shift.shift(of("R1"), 10'000.0, kNow, {.began = 1, .ended = 2});
  shift.shift(of("R1"), 9001.0, kNow + 1, {.began = 3, .ended = 4});  // set back by 1000 s
  const icd::Stamp later = shift.shift(of("R1"), 9005.0, kNow + 5, {.began = 6, .ended = 7});
  const icd::Stamp shown = shift.shift(of("R1"), 9006.5, kNow + 6.5, {.began = 8, .ended = 9});
  ASSERT_THAT(shown, DoubleNear(kNow + 6.5, 1e-6));
  const Upload slow{.began = 5, .ended = 10};
  EXPECT_THAT(shift.shift(of("R1"), 9004.0, kNow + 7, slow), DoubleNear(later - 1, 1e-6));
  EXPECT_THAT(shift.shift(of("R1"), 9007.0, kNow + 7, {.began = 6, .ended = 11}),
              DoubleNear(shown + 0.5, 1e-6));
}

TEST(StampShift, AStepNeverGoesBehindTheLatestStamp) {
  StampShift shift;
  run(shift, 10'000, kNow, 1);
  const icd::Stamp ahead = shift.shift(of("R1"), 10'005, kNow + 1.1);
  const icd::Stamp first = shift.shift(of("R1"), 100, kNow + 1.2);
  EXPECT_EQ(first, ahead) << "the pose counts";
  EXPECT_THAT(shift.shift(of("R1"), 100.3, kNow + 1.3), DoubleNear(first + 0.3, 1e-6));
}

TEST(StampShift, KeepsTheSpacingOfStampsOfAnySize) {
  StampShift shift;
  EXPECT_EQ(shift.shift(of("R1"), 1e308, kNow), kNow);
  EXPECT_EQ(shift.shift(of("R1"), 1e308, kNow + 1), kNow);
  EXPECT_EQ(shift.shift(of("R1"), std::numeric_limits<double>::max(), kNow + 1), kNow + 1);
  EXPECT_EQ(shift.shift(of("R1"), std::numeric_limits<double>::denorm_min(), kNow + 2), kNow + 2);
}

TEST(StampShift, IsNeverNegativeNorFarAheadOfNow) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> any{0, 60};
  StampShift shift;
  for (int i = 0; i < 2000; ++i) {
    const double now = i * 0.1;
    const auto stamp = shift.shift(of("R1"), any(random), now);
    ASSERT_GE(stamp, 0);
    ASSERT_LE(stamp, now + StampShift::kJump);
  }
}

TEST(StampShift, ForgetsTheLongestSilentAddress) {
  StampShift shift;
  const Stamper silent = of("R1", "silent"), busy = of("R1", "busy");
  shift.shift(silent, 100.0, kNow);
  shift.shift(busy, 100.0, kNow);
  for (std::size_t i = 1; i < StampShift::kMostAddresses; ++i) {
    shift.shift(of("R1", std::to_string(i)), 5.0, kNow);
    shift.shift(busy, 100.0, kNow);
  }
  EXPECT_THAT(shift.shift(busy, 100.5, kNow + 3), DoubleNear(kNow + 0.5, 1e-6));
  EXPECT_EQ(shift.shift(silent, 100.5, kNow + 3), kNow + 3) << "the robot was restarted";
}

TEST(StampShift, LimitsTheClocksOfAnAddress) {
  StampShift shift;
  const Stamper other = of("R1", "10.0.0.6"), first = of("0"), late = of("late");
  shift.shift(other, 100.0, kNow);
  for (int i = 0; i < 2000; ++i) shift.shift(of(std::to_string(i)), 5.0, kNow);
  EXPECT_EQ(shift.shift(late, 7.0, kNow + 1), kNow + 2) << "further robots share one clock";
  EXPECT_LE(shift.clocks().size(), 1 + StampShift::kMostOfAddress);
  EXPECT_THAT(shift.shift(first, 5.5, kNow + 3), DoubleNear(kNow + 0.5, 1e-6)) << "its own clock continues";
  EXPECT_THAT(shift.shift(other, 100.5, kNow + 3), DoubleNear(kNow + 0.5, 1e-6));
  for (const icd::Uri uri : icd::kUris) shift.shift({"10.0.0.5", uri, "new"}, 5.0, kNow);
  EXPECT_EQ(shift.clocks().size(), 1 + StampShift::kMostOfAddress);
}

icd::Marker marker(std::optional<icd::Stamp> stamp) {
  icd::Marker made;
  made.header.stamp = stamp;
  return made;
}

TEST(StampShift, KeepsTheSpacingOfMarkersInAMessage) {
  StampShift shift;
  const Stamper stamper{"10.0.0.5", icd::Uri::MarkersUpdate, ""};
  std::vector<icd::Marker> markers{marker({}), marker(50), marker(49.5), marker(51), marker(0)};
  shift.shift_each(stamper, markers, kNow);
  std::vector<icd::Marker> later{marker(51.5)};
  shift.shift_each(stamper, later, kNow + 3);
  std::vector<double> shifted;
  for (const auto* some : {&markers, &later})
    for (const icd::Marker& each : *some) shifted.push_back(*each.header.stamp - kNow);
  EXPECT_THAT(shifted, testing::Pointwise(DoubleNear(1e-6), {0.0, 0.0, -0.5, 1.0, 1.0, 1.5}));
}

/// A state's stamps are recorded with its poses.
TEST(StampShift, ReportsEachChangedClockOnce) {
  StampShift shift;
  shift.shift(of("R1"), {}, kNow);
  EXPECT_TRUE(shift.take_changed().empty());
  for (const char* robot : {"R2", "R1", "R2"}) shift.shift(of(robot), 100.0, kNow);
  shift.shift(of("R2"), 101.0, kNow);
  const auto changed = shift.take_changed();
  ASSERT_EQ(changed.size(), 2);
  EXPECT_EQ(changed[0].first, of("R2"));
  EXPECT_EQ(changed[0].second.latest, 101.0);
  EXPECT_TRUE(shift.take_changed().empty());
  shift.shift(of("R2"), 101.5, kNow + 1);
  EXPECT_TRUE(shift.take_changed().empty()) << "the clock did not change";
  shift.shift(of("R2"), 110.0, kNow + 1);
  EXPECT_EQ(shift.take_changed().size(), 1) << "the clock was set again";
  for (const icd::Uri uri : {icd::Uri::MapUpdate, icd::Uri::MarkersUpdate}) {
    for (const double stamp : {50.0, 51.0}) {
      shift.shift({"R1", uri, ""}, stamp, kNow);
      EXPECT_EQ(shift.take_changed().size(), 1);
    }
  }
}

/// A restart at any message must not be visible, unless a clock is set back.
TEST(StampShift, ContinuesUnchangedAfterARestart) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> step{-2, 4};
  StampShift uninterrupted, living;
  double theirs = 9000;
  for (int i = 0; i < 3000; ++i) {
    const double now = kNow + i * 0.5;
    const std::string sender = "R" + std::to_string(i % 3);
    theirs = std::max(0.0, theirs + step(random) + 1.2);
    ASSERT_EQ(living.shift(of(sender), theirs, now), uninterrupted.shift(of(sender), theirs, now)) << i;
    StampShift next;
    for (const auto& [each, clock] : living.clocks()) next.restore(each, clock);
    living = std::move(next);
  }
}

TEST(StampShift, KnowsTheClockOfARobotThatSendsForAWhile) {
  StampShift shift;
  EXPECT_FALSE(shift.sender_time(kNow, 0, 1e9));
  for (int second = 0; second <= 9; ++second) shift.shift(of("R1"), 5000.0 + second, kNow + second);
  EXPECT_FALSE(shift.sender_time(kNow + 9, 0, 1e9));
  shift.shift(of("R1"), 5010.0, kNow + 10);
  EXPECT_THAT(*shift.sender_time(kNow + 12, 0, 1e9), DoubleNear(5012, 1e-6));
  for (int second = 0; second <= 10; ++second) shift.shift(of("R2"), 100.0 + second, kNow + second);
  EXPECT_THAT(*shift.sender_time(kNow + 12, 0, 1e9), DoubleNear(112, 1e-6)) << "the earliest stamp";
  EXPECT_THAT(*shift.sender_time(kNow + 12, 1000, 1e9), DoubleNear(5012, 1e-6))
      << "the other robot's clock is not set";
  EXPECT_THAT(*shift.sender_time(kNow + 12, 0, 1000), DoubleNear(112, 1e-6));
  EXPECT_FALSE(shift.sender_time(kNow + 21, 0, 1e9)) << "the robots are silent";
}

TEST(StampShift, ForgetsTheLongestSilentAddressAfterARestart) {
  StampShift shift;
  const auto at = [](std::size_t address) { return of("R1", std::to_string(address)); };
  for (std::size_t i = 0; i < StampShift::kMostAddresses; ++i) shift.shift(at(i), 5.0, kNow);
  shift.shift(at(0), 5.5, kNow);
  StampShift next;
  for (const auto& [sender, clock] : shift.clocks()) next.restore(sender, clock);
  next.shift(of("R1", "new"), 5.0, kNow + 9);
  EXPECT_THAT(next.shift(at(0), 6.0, kNow + 9), DoubleNear(kNow + 1, 1e-6));
  EXPECT_EQ(next.shift(at(1), 6.0, kNow + 9), kNow + 9);
}

}  // namespace
}  // namespace adit::queues
