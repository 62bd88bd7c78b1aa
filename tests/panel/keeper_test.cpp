// adit-panel and aditd, connected by their socket, on one loop.
#include "panel/keeper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "loop/simulated_time.hpp"
#include "panel/messages.hpp"
#include "panel/reopened.hpp"
#include "panel/watched_lines.hpp"
#include "panel/wire.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Lit kTold{true, true, true, false};

class KeeperTest : public testing::Test {
 protected:
  KeeperTest() {
    std::string name = (std::filesystem::temp_directory_path() / "adit-keeper-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~KeeperTest() override { std::filesystem::remove_all(folder_); }

  std::string socket() const { return (folder_ / "socket").string(); }
  void begin() {
    auto listening = listening_at(socket());
    ASSERT_TRUE(listening);
    keeper_.emplace(
        loop_, std::move(listening), settings::Panel{},
        Keeper::Callbacks{.open =
                              [this](const settings::Panel&) {
                                return PanelDevices{std::make_unique<WatchedLines>(seen_),
                                                    std::make_unique<WireLine>(wire_)};
                              },
                          .complain = [this](const std::string& sentence) { log_.push_back(sentence); }});
  }
  PanelDevices connect() {
    auto held = remote(socket(), {});
    EXPECT_TRUE(held.has_value());
    EXPECT_TRUE(held->lines->set(kTold).has_value());
    loop_.turn(10ms);
    return std::move(*held);
  }
  /// Changes the wire, and lets the user read it.
  void set(bool pressed) {
    const int looked = wire_.looked;
    wire_.set(pressed);
    EXPECT_TRUE(time_.pass_until(loop_, [&] { return wire_.looked > looked; }));
  }
  long log_count(std::string_view part) const {
    return std::ranges::count_if(log_, [&](const std::string& each) { return each.contains(part); });
  }

  std::filesystem::path folder_;
  loop::SimulatedTime time_;
  loop::Loop loop_;
  WatchedLines::Seen seen_;
  Wire wire_;
  std::vector<std::string> log_;
  std::optional<Keeper> keeper_;
};

TEST_F(KeeperTest, ReportsFailureAndRecoveryOfTheLights) {
  begin();
  const PanelDevices held = connect();
  seen_.fail = true;
  std::expected<void, std::string> set;
  const auto is_told = [&](bool well) {
    return time_.pass_until(loop_, [&] {
      [[maybe_unused]] const auto level = held.button->is_pressed();
      set = held.lines->set(kTold);
      return set.has_value() == well;
    });
  };
  EXPECT_TRUE(is_told(false));
  EXPECT_EQ(set.error(), "gpiochip0: gone");
  seen_.fail = false;
  EXPECT_TRUE(is_told(true));
  EXPECT_EQ(log_count("cannot set the lights"), 1);
  EXPECT_EQ(log_count("the lights work again"), 1);
}

TEST_F(KeeperTest, ReportsAPress) {
  begin();
  const PanelDevices held = connect();
  EXPECT_EQ(held.button->is_pressed(), false);
  set(true);
  EXPECT_EQ(held.button->is_pressed(), true);
  set(false);
  EXPECT_EQ(held.button->is_pressed(), false);
}

TEST_F(KeeperTest, LostButtonCancelsAPress) {
  begin();
  const PanelDevices held = connect();
  set(true);
  EXPECT_EQ(held.button->is_pressed(), true);
  wire_.broken = true;
  set(false);
  wire_.broken = false;
  set(false);
  EXPECT_FALSE(held.button->is_pressed().has_value()) << "a lost button is not a release";
  EXPECT_EQ(held.button->is_pressed(), false);
  EXPECT_EQ(log_count("cannot read the button"), 1);
  EXPECT_EQ(log_count("button works again"), 1);
}

TEST_F(KeeperTest, SilentlyLostButtonIsNoticedAtTheNextBeat) {
  begin();
  const PanelDevices held = connect();
  set(true);
  EXPECT_EQ(held.button->is_pressed(), true);
  wire_.broken = true;
  EXPECT_TRUE(held.lines->set(kTold).has_value());
  EXPECT_TRUE(time_.pass_until(loop_, [&] { return !held.button->is_pressed().has_value(); }));
}

TEST_F(KeeperTest, ReturnedButtonNeedsARelease) {
  begin();
  const PanelDevices held = connect();
  wire_.broken = true;
  set(false);
  EXPECT_FALSE(held.button->is_pressed().has_value());
  wire_.broken = false;
  set(true);
  EXPECT_EQ(held.button->is_pressed(), false);
  set(false);
  EXPECT_EQ(held.button->is_pressed(), false);
  set(true);
  EXPECT_EQ(held.button->is_pressed(), true);
}

TEST_F(KeeperTest, NewClientIsToldOfALostButton) {
  wire_.broken = true;
  begin();
  const PanelDevices held = connect();
  EXPECT_FALSE(held.button->is_pressed().has_value());
}

TEST_F(KeeperTest, EndOfAditPanelCancelsAPress) {
  begin();
  const PanelDevices held = connect();
  set(true);
  EXPECT_EQ(held.button->is_pressed(), true);
  keeper_.reset();
  EXPECT_TRUE(held.lines->set(kTold).has_value()) << "the lines may come back";
  wire_.pressed = false;
  begin();
  EXPECT_TRUE(held.lines->set(kTold).has_value());
  EXPECT_FALSE(held.button->is_pressed().has_value());
  EXPECT_EQ(held.button->is_pressed(), false);
}

}  // namespace
}  // namespace adit::panel
