#include "gateway/lights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace adit::gateway {
namespace {

using Lit = std::array<bool, panel::kLights.size()>;

/// Remembers what it was told to show; fails when asked to.
class WatchedLines final : public panel::Lines {
 public:
  struct Seen {
    std::vector<Lit> shown;
    bool fail = false;
  };
  explicit WatchedLines(Seen& seen) : seen_(seen) {}
  std::expected<void, std::string> set(const Lit& lit) override {
    seen_.shown.push_back(lit);
    if (seen_.fail) return std::unexpected("gpiochip0: gone");
    return {};
  }

 private:
  Seen& seen_;
};

TEST(Lights, SetsTheLinesOnlyWhenSomethingChanges) {
  loop::Loop loop;
  WatchedLines::Seen seen;
  Lights lights(loop, std::make_unique<WatchedLines>(seen));
  panel::Condition well{.serving = true, .scoring_connected = true, .mapping_connected = true};
  lights.show(well);
  lights.show(well);
  ASSERT_EQ(seen.shown.size(), 1u);
  EXPECT_TRUE(seen.shown[0][static_cast<std::size_t>(panel::Light::Health)]);
  EXPECT_FALSE(seen.shown[0][static_cast<std::size_t>(panel::Light::Attention)]);
}

TEST(Lights, BlinkByTheLoopsTimer) {
  loop::Loop loop;
  WatchedLines::Seen seen;
  Lights lights(loop, std::make_unique<WatchedLines>(seen));
  lights.show(
      {.serving = true, .scoring_connected = true, .mapping_connected = true, .needs_operator = true});
  const auto until = loop.now() + std::chrono::seconds(5);
  while (seen.shown.size() < 4 && loop.now() < until) loop.turn(std::chrono::milliseconds(200));
  ASSERT_GE(seen.shown.size(), 4u);
  const auto attention = static_cast<std::size_t>(panel::Light::Attention);
  EXPECT_NE(seen.shown[1][attention], seen.shown[2][attention]);
  EXPECT_NE(seen.shown[2][attention], seen.shown[3][attention]);
}

TEST(Lights, AllFlashTogetherWhileTheBoxIsIdentifiedAndThenTellOfTheConditionAgain) {
  loop::Loop loop;
  WatchedLines::Seen seen;
  Lights lights(loop, std::make_unique<WatchedLines>(seen));
  lights.show({.serving = true, .scoring_connected = true, .mapping_connected = true});
  lights.identify(std::chrono::milliseconds(600));
  EXPECT_EQ(lights.shown(), panel::kIdentify);
  lights.show({.serving = true, .scoring_connected = true});
  EXPECT_EQ(lights.shown(), panel::kIdentify) << "whatever happens meanwhile";
  EXPECT_GT(lights.identifying().value_or(loop::Duration{0}), std::chrono::milliseconds(0));
  const auto until = loop.now() + std::chrono::seconds(5);
  while (lights.shown() == panel::kIdentify && loop.now() < until) loop.turn(std::chrono::milliseconds(200));
  EXPECT_EQ(lights.identifying(), std::nullopt);
  EXPECT_EQ(lights.shown()[static_cast<std::size_t>(panel::Light::Mapping)], panel::Pattern::Off);
  EXPECT_EQ(seen.shown.back(), (Lit{true, true, false, false}));
  EXPECT_NE(std::ranges::find(seen.shown, Lit{}), seen.shown.end()) << "all were dark between two flashes";
  EXPECT_NE(std::ranges::find(seen.shown, Lit{true, true, true, true}), seen.shown.end());
}

TEST(Lights, GoOnAfterThePanelFails) {
  loop::Loop loop;
  WatchedLines::Seen seen;
  seen.fail = true;
  Lights lights(loop, std::make_unique<WatchedLines>(seen));
  lights.show({.serving = true});
  lights.show({.serving = true, .scoring_connected = true});
  EXPECT_EQ(seen.shown.size(), 2u);
}

}  // namespace
}  // namespace adit::gateway
