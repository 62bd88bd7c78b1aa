#include "gateway/lights.hpp"

#include <gtest/gtest.h>

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
