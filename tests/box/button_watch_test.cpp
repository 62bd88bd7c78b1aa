#include <gtest/gtest.h>

#include <optional>

#include "box/lights.hpp"
#include "loop/simulated_time.hpp"
#include "panel/watched_lines.hpp"
#include "panel/wire.hpp"

namespace adit::box {
namespace {

using namespace std::chrono_literals;
using panel::LightState;
using panel::Press;
using panel::WatchedLines;
using panel::Wire;
using panel::WireLine;

class ButtonWatchTest : public testing::Test {
 protected:
  void watch() {
    button.emplace(loop, std::make_unique<WireLine>(wire), lights,
                   [this](Press press) { presses.push_back(press); });
  }
  /// For longer than it may bounce.
  void set(bool pressed) {
    wire.set(pressed);
    time.pass(loop, 100ms);
  }

  loop::SimulatedTime time;
  loop::Loop loop;
  WatchedLines::Seen seen;
  Lights lights{loop, std::make_unique<WatchedLines>(seen)};
  Wire wire;
  std::vector<Press> presses;
  std::optional<ButtonWatch> button;
};

TEST_F(ButtonWatchTest, ReportsAPressOnRelease) {
  watch();
  set(true);
  EXPECT_TRUE(presses.empty());
  set(false);
  EXPECT_EQ(presses, std::vector{Press::Identify});
  const int looked = wire.looked;
  time.pass(loop, 1s);
  EXPECT_EQ(wire.looked, looked) << "an untouched button must not be polled";
}

TEST_F(ButtonWatchTest, IgnoresABounce) {
  watch();
  for (int i = 0; i < 10; ++i) {
    wire.set(i % 2 == 0);
    time.pass(loop, panel::Button::kBounce - 1ms);
  }
  time.pass(loop, 100ms);
  EXPECT_TRUE(presses.empty());
}

TEST_F(ButtonWatchTest, ShowsWhenToRelease) {
  watch();
  lights.set(LightState::Serving, true);
  wire.set(true);
  time.pass(loop, panel::Button::kHold - 1ms);
  EXPECT_FALSE(lights.has(LightState::ButtonHeld));
  time.pass(loop, 2ms);
  EXPECT_TRUE(lights.has(LightState::ButtonHeld));
  set(false);
  EXPECT_FALSE(lights.has(LightState::ButtonHeld));
  EXPECT_EQ(presses, std::vector{Press::ShowAddress});
}

TEST_F(ButtonWatchTest, IgnoresAStuckButton) {
  wire.pressed = true;
  watch();
  time.pass(loop, 3200ms);
  EXPECT_FALSE(lights.has(LightState::ButtonHeld));
  set(false);
  EXPECT_TRUE(presses.empty());
}

TEST_F(ButtonWatchTest, CancelsAPressIfTheButtonFails) {
  watch();
  set(true);
  time.pass(loop, 3200ms);
  EXPECT_TRUE(lights.has(LightState::ButtonHeld));
  wire.broken = true;
  set(false);
  EXPECT_FALSE(lights.has(LightState::ButtonHeld));
  wire.broken = false;
  set(false);
  EXPECT_TRUE(presses.empty()) << "a lost button is not a release";
}

TEST_F(ButtonWatchTest, RetriesAButtonThatCouldNotBeRead) {
  wire.broken = true;
  watch();
  wire.broken = false;
  const int looked = wire.looked;
  time.pass(loop, 2s);
  EXPECT_GT(wire.looked, looked) << "although the button is not touched";
  set(true);
  set(false);
  EXPECT_EQ(presses, std::vector{Press::Identify});
}

TEST_F(ButtonWatchTest, IgnoresAButtonPressedAtItsReturn) {
  watch();
  wire.broken = true;
  set(true);
  wire.broken = false;
  set(true);
  time.pass(loop, 3200ms);
  EXPECT_FALSE(lights.has(LightState::ButtonHeld));
  set(false);
  EXPECT_TRUE(presses.empty());
  set(true);
  set(false);
  EXPECT_EQ(presses, std::vector{Press::Identify});
}

TEST_F(ButtonWatchTest, WorksWithoutALine) {
  button.emplace(loop, nullptr, lights, [this](Press press) { presses.push_back(press); });
  time.pass(loop, 50ms);
  EXPECT_TRUE(presses.empty());
}

TEST_F(ButtonWatchTest, ReleasesItsLine) {
  watch();
  EXPECT_TRUE(wire.open);
  button.reset();
  EXPECT_FALSE(wire.open);
}

TEST_F(ButtonWatchTest, ContinuesWithAnotherLine) {
  watch();
  button->release_line();
  EXPECT_FALSE(wire.open);
  button->set_line(std::make_unique<WireLine>(wire));
  set(true);
  set(false);
  EXPECT_EQ(presses, std::vector{Press::Identify});
}

}  // namespace
}  // namespace adit::box
