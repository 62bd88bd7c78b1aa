#include "loop/simulated_time.hpp"

#include <gtest/gtest.h>

namespace adit::loop {
namespace {

using namespace std::chrono_literals;

TEST(SimulatedTime, AdvancesOnlyByRequest) {
  SimulatedTime time;
  Loop loop;
  const Instant began = loop.now();
  const double of_day = loop.wall_now(), stamp = loop.stamp_now();
  loop.turn(2ms);
  EXPECT_EQ(loop.now(), began);
  time.pass(90min);
  EXPECT_EQ(loop.now() - began, 90min);
  EXPECT_EQ(loop.wall_now() - of_day, 5400);
  EXPECT_EQ(loop.stamp_now() - stamp, 5400);
  EXPECT_EQ(loop.check_wall_clock(false), 0) << "no clock step: all clocks run at one rate";
}

TEST(SimulatedTime, DrivesTimers) {
  SimulatedTime time;
  Loop loop;
  int calls = 0;
  Source timer;
  timer = loop.timer([&] { ++calls, timer.call_at(loop.now() + 10ms); });
  timer.call_at(loop.now() + 10ms);
  time.pass(loop, 9ms);
  EXPECT_EQ(calls, 0);
  time.pass(loop, 1ms);
  EXPECT_EQ(calls, 1);
  time.pass(loop, 1s);
  EXPECT_EQ(calls, 101);
  EXPECT_TRUE(time.pass_until(loop, [&] { return calls == 103; }, 20ms));
  EXPECT_FALSE(time.pass_until(loop, [&] { return calls == 105; }, 19ms));
}

TEST(SimulatedTime, EndsWithRealTime) {
  const Instant before = std::chrono::steady_clock::now();
  {
    SimulatedTime().pass(1h);
  }
  const Instant after = std::chrono::steady_clock::now();
  EXPECT_GE(after, before);
  EXPECT_LT(after - before, 1h);
}

}  // namespace
}  // namespace adit::loop
