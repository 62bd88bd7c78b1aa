#include "box/lights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "loop/simulated_time.hpp"
#include "panel/watched_lines.hpp"

namespace adit::box {
namespace {

using namespace std::chrono_literals;
using panel::LightState;
using panel::Lit;
using panel::Pattern;
using panel::WatchedLines;

constexpr std::size_t kHealth = panel::index_of(panel::Light::Health),
                      kMapping = panel::index_of(panel::Light::Mapping),
                      kAttention = panel::index_of(panel::Light::Attention);

class LightsTest : public testing::Test {
 protected:
  void be_well() {
    for (const LightState state :
         {LightState::Serving, LightState::ScoringConnected, LightState::MappingConnected}) {
      lights.set(state, true);
    }
  }

  loop::SimulatedTime time;
  loop::Loop loop;
  WatchedLines::Seen seen;
  Lights lights{loop, std::make_unique<WatchedLines>(seen)};
};

TEST_F(LightsTest, SetTheLinesOnlyAfterAChange) {
  be_well();
  const std::size_t changes = seen.shown.size();
  EXPECT_EQ(seen.shown.back(), (Lit{true, true, true, false}));
  be_well();
  lights.set(LightState::NeedsOperator, false);
  EXPECT_EQ(seen.shown.size(), changes);
}

TEST_F(LightsTest, AreAllDarkAtFirst) {
  lights.set(LightState::Serving, false);
  ASSERT_EQ(seen.shown.size(), 1u) << "independent of earlier lights";
  EXPECT_EQ(seen.shown.back(), Lit{});
}

TEST_F(LightsTest, BlinkByTheTimerOfTheLoop) {
  be_well();
  lights.set(LightState::NeedsOperator, true);
  seen.shown.clear();
  time.pass(loop, 1010ms);
  ASSERT_EQ(seen.shown.size(), 8u) << "steps of 125 ms";
  for (std::size_t i = 1; i < 8; ++i) EXPECT_NE(seen.shown[i][kAttention], seen.shown[i - 1][kAttention]);
}

TEST_F(LightsTest, KeepTheirRhythmWhileTheSameIsRepeated) {
  lights.set(LightState::NeedsOperator, true);
  seen.shown.clear();
  for (int i = 0; i < 101; ++i) {
    lights.set(LightState::NeedsOperator, true);
    time.pass(loop, 10ms);
  }
  EXPECT_EQ(seen.shown.size(), 8u);
}

TEST_F(LightsTest, FlashTogetherWhileIdentified) {
  be_well();
  lights.set_for(LightState::Identify, 3s);
  constexpr panel::Lights kTwice = {Pattern::Twice, Pattern::Twice, Pattern::Twice, Pattern::Twice};
  EXPECT_EQ(lights.shown_lights(), kTwice);
  lights.set(LightState::MappingConnected, false);
  EXPECT_EQ(lights.shown_lights(), kTwice) << "independent of other states";
  EXPECT_GT(lights.remaining(LightState::Identify).value_or(0ms), 0ms);
  const auto showed = [&](const Lit& lit) { return std::ranges::find(seen.shown, lit) != seen.shown.end(); };
  time.pass(loop, 3s - 1ms);
  EXPECT_TRUE(showed(Lit{}) && showed(Lit{true, true, true, true}));
  EXPECT_EQ(lights.shown_lights(), kTwice);
  time.pass(loop, 1ms);
  EXPECT_EQ(lights.remaining(LightState::Identify), std::nullopt);
  EXPECT_FALSE(lights.has(LightState::Identify));
  EXPECT_EQ(lights.shown_lights()[kMapping], Pattern::Off);
  EXPECT_EQ(seen.shown.back(), (Lit{true, true, false, false}));
}

TEST_F(LightsTest, PlayDigitsOnceOnTheAttentionLight) {
  be_well();
  time.pass(loop, 30ms);
  const Lit dark{}, digit{false, false, false, true}, well{true, true, true, false};
  const std::vector all{dark, digit, dark, digit, dark, well};
  seen.shown.clear();
  lights.play_digits({{false, 100ms}, {true, 100ms}, {false, 100ms}, {true, 200ms}, {false, 100ms}});
  EXPECT_EQ(lights.shown_lights()[kAttention], Pattern::Digits);
  time.pass(loop, 599ms);
  EXPECT_TRUE(lights.has(LightState::Address));
  time.pass(loop, 1ms);
  EXPECT_FALSE(lights.has(LightState::Address));
  EXPECT_EQ(seen.shown, all);
}

TEST_F(LightsTest, ClearATimedStateEarly) {
  lights.set(LightState::Serving, true);
  lights.set_for(LightState::Identify, 1h);
  lights.set(LightState::Identify, false);
  EXPECT_EQ(lights.remaining(LightState::Identify), std::nullopt);
  EXPECT_EQ(lights.shown_lights()[kHealth], Pattern::On);
}

TEST_F(LightsTest, ContinueAfterThePanelFails) {
  seen.fail = true;
  lights.set(LightState::Serving, true);
  lights.set(LightState::ScoringConnected, true);
  EXPECT_EQ(seen.shown.size(), 2u);
}

TEST_F(LightsTest, RetryAFailedPanelWithoutAChange) {
  seen.fail = true;
  lights.set(LightState::Serving, true);
  EXPECT_EQ(lights.trouble(), "gpiochip0: gone");
  seen.fail = false;
  seen.shown.clear();
  lights.set(LightState::Serving, true);
  EXPECT_TRUE(seen.shown.empty()) << "fewer updates than requests";
  time.pass(loop, panel::Painter::kAgain);
  EXPECT_EQ(seen.shown, (std::vector{Lit{true, false, false, false}}));
  time.pass(loop, panel::Painter::kMended - 1ms);
  EXPECT_EQ(lights.trouble(), "gpiochip0: gone") << "a loose contact is possible";
  time.pass(loop, panel::Painter::kConfirm);
  EXPECT_EQ(lights.trouble(), "");
}

TEST_F(LightsTest, RepeatAsAHeartbeatIfWatched) {
  WatchedLines::Seen watched{.shown = {}, .is_watched = true};
  be_well();
  lights.release_lines();
  lights.set_lines(std::make_unique<WatchedLines>(watched));
  EXPECT_EQ(watched.shown.size(), 1u) << "at once";
  for (int i = 0; i < 3; ++i) {
    time.pass(loop, 1s);
    lights.send_heartbeat();
  }
  EXPECT_EQ(watched.shown.size(), 4u) << "then only with each beat";
  for (const Lit& lit : watched.shown) EXPECT_EQ(lit, (Lit{true, true, true, false}));
  watched.fail = true;
  const std::size_t before = watched.shown.size();
  lights.send_heartbeat();
  time.pass(loop, panel::Painter::kAgain);
  EXPECT_EQ(watched.shown.size(), before + 2) << "the write is repeated";
  lights.release_lines();
  watched.shown.clear();
  lights.set(LightState::NeedsOperator, true);
  lights.send_heartbeat();
  time.pass(loop, 1s);
  EXPECT_TRUE(watched.shown.empty());
}

TEST_F(LightsTest, DoNotRepeatUnlessWatched) {
  be_well();
  const std::size_t told = seen.shown.size();
  lights.send_heartbeat();
  EXPECT_EQ(seen.shown.size(), told);
}

TEST_F(LightsTest, ShowTheSameOnNewLines) {
  be_well();
  WatchedLines::Seen other;
  lights.release_lines();
  lights.set(LightState::NeedsOperator, true);  // the lights cannot be set meanwhile
  lights.set_lines(std::make_unique<WatchedLines>(other));
  EXPECT_EQ(other.shown, (std::vector<Lit>{{true, true, true, true}}));
}

}  // namespace
}  // namespace adit::box
