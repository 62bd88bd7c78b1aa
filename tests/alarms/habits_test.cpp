#include "alarms/habits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace adit::alarms {
namespace {

using testing::IsEmpty;

class HabitsTest : public testing::Test {
 protected:
  /// The robot posts `times` times, every `gap` seconds, and is checked each second.
  void speaks(const std::string& robot, double gap, int times) {
    for (int i = 0; i < times; ++i) {
      for (double later = now_ + gap; now_ < later; now_ += 1) habits_.on_count(robot, count_, now_);
      habits_.on_count(robot, ++count_, now_);
    }
  }
  bool is_silent_after(const std::string& robot, double seconds) {
    const auto robots = habits_.robots(rules_, now_ + seconds);
    return robots.contains(robot) && robots.at(robot).silent;
  }

  Habits habits_;
  Habits::Rules rules_;
  double now_ = 1000;
  std::uint64_t count_ = 1;
};

TEST_F(HabitsTest, BlameARobotSilentBeyondTheMinimum) {
  speaks("uav5", 1, 20);
  EXPECT_FALSE(is_silent_after("uav5", 30));
  EXPECT_TRUE(is_silent_after("uav5", 31));
}

TEST_F(HabitsTest, AllowASlowRobotItsGaps) {
  speaks("ugv1", 40, 10);
  EXPECT_FALSE(is_silent_after("ugv1", 190));
  EXPECT_TRUE(is_silent_after("ugv1", 210));
}

TEST_F(HabitsTest, FollowTheLongestGapsOfAnUnevenRobot) {
  for (int i = 0; i < 5; ++i) {
    speaks("ugv1", 1, 10);
    speaks("ugv1", 40, 1);
  }
  EXPECT_FALSE(is_silent_after("ugv1", 60)) << "the robot sometimes pauses for 40 s";
}

TEST_F(HabitsTest, BlameAKnownRobotSilentSinceARestart) {
  habits_.expect("uav5", now_);
  EXPECT_FALSE(is_silent_after("uav5", 30));
  EXPECT_TRUE(is_silent_after("uav5", 31));
  now_ += 20;
  habits_.on_count("uav5", ++count_, now_);
  EXPECT_FALSE(is_silent_after("uav5", 100)) << "the robot has no habit yet";
  habits_.on_count("ugv1", 7, now_);
  habits_.expect("ugv1", now_);
  habits_.on_count("ugv1", 7, now_ + 20);
  EXPECT_TRUE(is_silent_after("ugv1", 31)) << "its messages were queued before";
  habits_.expect("uav6", now_);
  speaks("uav6", 1, 1);
  habits_.expect("uav6", now_);
  EXPECT_FALSE(is_silent_after("uav6", 100)) << "the robot was heard";
}

TEST_F(HabitsTest, SurviveARestart) {
  speaks("uav5", 1, 20);
  Habits next;
  next.restore("uav5", *habits_.habit_of("uav5"), 1);  // a message that was queued before
  next.on_count("uav5", 1, now_ + 5);
  EXPECT_FALSE(next.robots(rules_, now_ + 30).at("uav5").silent);
  EXPECT_TRUE(next.robots(rules_, now_ + 31).at("uav5").silent) << "counted from its last message";
  next.expect("uav5", now_ + 40);
  EXPECT_EQ(next.robots(rules_, now_ + 60).at("uav5").quiet, 60);
  next.on_count("uav5", 2, now_ + 61);
  EXPECT_FALSE(next.robots(rules_, now_ + 62).contains("uav5")) << "the robot comes back";
}

TEST_F(HabitsTest, IgnoreRobotsWithoutHabits) {
  speaks("uav5", 1, Habits::kMessages - 2);
  EXPECT_THAT(habits_.robots(rules_, now_ + 100), IsEmpty());
}

TEST_F(HabitsTest, ExcludeSilences) {
  speaks("uav5", 1, 20);
  speaks("uav5", 300, 1);
  speaks("uav5", 1, 20);
  EXPECT_TRUE(is_silent_after("uav5", 31));
}

TEST_F(HabitsTest, ForgetRobotsThatWereSwitchedOff) {
  speaks("uav5", 1, 20);
  EXPECT_TRUE(is_silent_after("uav5", rules_.away - 1));
  EXPECT_FALSE(is_silent_after("uav5", rules_.away + 1));
}

TEST_F(HabitsTest, ExcludeTheMergedMap) {
  speaks("", 1, 20);
  EXPECT_THAT(habits_.robots(rules_, now_), IsEmpty());
}

TEST_F(HabitsTest, ReplaceRobotsThatWereSwitchedOff) {
  for (std::size_t robot = 0; robot < Habits::kMost; ++robot) speaks("r" + std::to_string(robot), 1, 1);
  speaks("uav5", 1, 20);
  EXPECT_FALSE(habits_.habit_of("uav5"));
  now_ += rules_.away + 1;
  speaks("uav5", 1, 20);
  EXPECT_TRUE(habits_.robots(rules_, now_).contains("uav5"));
}

TEST_F(HabitsTest, LimitTheNumberOfRobots) {
  for (int robot = 0; robot < 1000; ++robot) speaks("r" + std::to_string(robot), 1, 1);
  for (int robot = 0; robot < 1000; ++robot) speaks("r" + std::to_string(robot), 1, 5);
  EXPECT_LE(habits_.robots({.least = 1e9, .times = 5, .away = 1e9}, now_).size(), Habits::kMost);
}

constexpr std::size_t kRoom = 100u << 20;

TEST(Growth, IsReportedOnceItLasts) {
  Growth growth;
  double now = 1000;
  for (int second = 0; second < 120; ++second)
    growth.update(static_cast<std::size_t>(second) << 18, kRoom, now++);
  EXPECT_TRUE(growth.grows(now));
  EXPECT_FALSE(growth.grows(now + Growth::kTold + Growth::kStep)) << "the growth is over";
}

TEST(Growth, IgnoresOneLargeMap) {
  Growth growth;
  double now = 1000;
  for (int second = 0; second < 120; ++second) growth.update(second % 20 < 10 ? kRoom / 2 : 0, kRoom, now++);
  EXPECT_FALSE(growth.grows(now));
}

TEST(Growth, IgnoresSmallGrowth) {
  Growth growth;
  double now = 1000;
  for (std::size_t second = 0; second < 120; ++second) growth.update(second << 10, kRoom, now++);
  EXPECT_FALSE(growth.grows(now));
}

}  // namespace
}  // namespace adit::alarms
