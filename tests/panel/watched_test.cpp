#include <gtest/gtest.h>

#include "panel/keeper.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;

constexpr Lit kAllWell{true, true, true, false}, kNoneLit{};
const Instant kItBegan = Instant() + 1h;

class WatchedTest : public testing::Test {
 protected:
  /// Whether only health blinks in the two seconds from `from`, which shows the fault.
  bool blinks_fault(Instant from) const {
    int lit = 0;
    for (auto at = from; at < from + 2s; at += 100ms) {
      const Lit seen = watched.frame(at).lit;
      if (seen != kNoneLit && seen != Lit{true, false, false, false}) return false;
      lit += seen[index_of(Light::Health)] ? 1 : 0;
    }
    return lit == 10;
  }

  HeartbeatMonitor watched{kItBegan};
};

TEST_F(WatchedTest, IsDarkUntilTheFirstMessage) {
  EXPECT_EQ(watched.frame(kItBegan + 40s).lit, kNoneLit);
  watched.on_contact(kItBegan + 40s);
  EXPECT_EQ(watched.frame(kItBegan + 80s).lit, kNoneLit) << "counted from the start of aditd";
  watched.on_lights(kAllWell, kItBegan + 81s);
  EXPECT_EQ(watched.frame(kItBegan + 81s).lit, kAllWell);
}

TEST_F(WatchedTest, ShowsAFaultIfNoProcessConnects) {
  EXPECT_FALSE(watched.is_faulty(kItBegan + HeartbeatMonitor::kStart - 1ms));
  EXPECT_TRUE(blinks_fault(kItBegan + HeartbeatMonitor::kStart));
}

TEST_F(WatchedTest, WakesWhenSilenceBecomesAFault) {
  watched.on_lights(kAllWell, kItBegan);
  const Frame frame = watched.frame(kItBegan + 1s);
  EXPECT_EQ(frame.lit, kAllWell);
  EXPECT_EQ(frame.lasts, HeartbeatMonitor::kSilence - 1s);
  EXPECT_FALSE(watched.is_faulty(kItBegan + HeartbeatMonitor::kSilence - 1ms));
  EXPECT_TRUE(blinks_fault(kItBegan + HeartbeatMonitor::kSilence));
}

TEST_F(WatchedTest, RecoversAfterAHang) {
  watched.on_lights(kAllWell, kItBegan);
  EXPECT_TRUE(watched.is_faulty(kItBegan + 10s));
  watched.on_lights(kAllWell, kItBegan + 10s);
  EXPECT_EQ(watched.frame(kItBegan + 10s).lit, kAllWell);
}

TEST_F(WatchedTest, ShowsACrashUntilTheNextProcessReports) {
  watched.on_lights(kAllWell, kItBegan);
  watched.on_gone(kItBegan + 100ms);
  EXPECT_TRUE(blinks_fault(kItBegan + 100ms));
  watched.on_contact(kItBegan + 2s);
  EXPECT_TRUE(watched.is_faulty(kItBegan + 2s)) << "aditd may die before its first message";
  watched.on_gone(kItBegan + 3s);
  EXPECT_TRUE(watched.is_faulty(kItBegan + 10min));
  watched.on_lights(kAllWell, kItBegan + 11min);
  EXPECT_EQ(watched.frame(kItBegan + 11min).lit, kAllWell);
}

TEST_F(WatchedTest, IsDarkAfterAnAnnouncedEnd) {
  watched.on_lights(kAllWell, kItBegan);
  watched.on_ended(kItBegan + 1s);
  watched.on_gone(kItBegan + 1s);
  EXPECT_EQ(watched.frame(kItBegan + 1s).lit, kNoneLit);
  EXPECT_FALSE(watched.is_faulty(kItBegan + 24h)) << "aditd was stopped";
  watched.on_contact(kItBegan + 24h);
  EXPECT_EQ(watched.frame(kItBegan + 24h).lit, kNoneLit);
  EXPECT_TRUE(watched.is_faulty(kItBegan + 24h + HeartbeatMonitor::kStart))
      << "aditd started without a message";
}

TEST_F(WatchedTest, ShowsACrashBeforeTheFirstMessage) {
  watched.on_contact(kItBegan);
  watched.on_gone(kItBegan + 1s);
  EXPECT_TRUE(blinks_fault(kItBegan + 1s));
}

TEST_F(WatchedTest, StaysFaultyIfAHungProcessIsKilled) {
  watched.on_lights(kAllWell, kItBegan);
  const Instant hung = kItBegan + HeartbeatMonitor::kSilence;
  const Frame before = watched.frame(hung + 600ms);
  watched.on_gone(hung + 600ms);
  EXPECT_EQ(watched.frame(hung + 600ms).lit, before.lit);
  EXPECT_TRUE(blinks_fault(hung + 1s));
}

}  // namespace
}  // namespace adit::panel
