#include <gtest/gtest.h>

#include <limits>

#include "clock/messages.hpp"

namespace adit::clock {
namespace {

using enum Source;

constexpr double kNow = 1.8e9;
constexpr Source kAll[] = {None, LastKnown, Robots, CommandPost, Chip, Operator, Ntp};

TEST(Source, MoreTrustedSetsTheClockEitherWay) {
  for (const double time : {kNow - 1e6, kNow + 1e6}) {
    EXPECT_EQ(time_to_set(LastKnown, {CommandPost, time}, kNow), time);
    EXPECT_EQ(time_to_set(Chip, {Operator, time}, kNow), time);
    EXPECT_EQ(time_to_set(CommandPost, {Operator, time}, kNow), time);
    EXPECT_EQ(time_to_set(Operator, {Ntp, time}, kNow), time);
  }
}

TEST(Source, OnlyTheOperatorSetsItTwice) {
  for (const Source present : kAll) {
    for (const Source offering : kAll) {
      if (offering > present) continue;
      EXPECT_EQ(time_to_set(present, {offering, kNow + 9}, kNow).has_value(), offering == Operator)
          << static_cast<int>(present) << ' ' << static_cast<int>(offering);
    }
  }
}

TEST(Source, LastKnownTimeAndRobotsSetItOnlyAhead) {
  for (const Source source : {LastKnown, Robots}) {
    EXPECT_EQ(time_to_set(None, {source, kNow + 60}, kNow), kNow + 60);
    EXPECT_FALSE(time_to_set(None, {source, kNow - 60}, kNow));
    EXPECT_FALSE(time_to_set(None, {source, kNow}, kNow));
  }
}

TEST(Source, RobotsSetItAheadByABoundedStep) {
  EXPECT_TRUE(time_to_set(LastKnown, {Robots, kNow + kRobotsMost}, kNow));
  EXPECT_FALSE(time_to_set(LastKnown, {Robots, kNow + kRobotsMost + 1}, kNow));
}

TEST(Source, RejectsTimesBeforeTheBuildAndAfterTheCentury) {
  for (const double time : {-1.0, 0.0, kEarliest - 1, kLatest, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(time_to_set(None, {Operator, time}, kNow)) << time;
  EXPECT_TRUE(time_to_set(None, {Operator, kEarliest}, kNow));
}

TEST(Source, GuessedTimesDoNotCountAsSet) {
  EXPECT_FALSE(is_set(None) || is_set(LastKnown) || is_set(Robots));
  EXPECT_TRUE(is_set(CommandPost) && is_set(Chip) && is_set(Operator) && is_set(Ntp));
}

}  // namespace
}  // namespace adit::clock
