// Lost lines and chips are opened again, with the test's own libgpiod.
#include "panel/reopened.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <cerrno>

#include "loop/file_descriptor.hpp"
#include "panel/fake_gpiod.hpp"
#include "panel/watched_lines.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Lit kWell{true, true, true, false};
constexpr const char* kChip = "/dev/gpiochip0";
constexpr const char* kNames[] = {"HEALTH", "SCORING", "MAPPING", "ATTENTION"};

class ReopenedChip : public testing::Test {
 protected:
  ReopenedChip() {
    fake_gpio() = {};
    for (const std::string name : {"HEALTH", "SCORING", "MAPPING", "ATTENTION", "BUTTON"})
      fake_gpio().chips[kChip].lines[name];
    line("BUTTON").level = true;  // pulled up
    line("BUTTON").descriptor = edges_.get();
    come();
  }
  static FakeLine& line(const std::string& name) { return fake_gpio().line(name); }
  /// Removes the chip and its lines. An open handle becomes invalid.
  static void vanish() {
    fake_gpio().chips[kChip].name = "";
    for (auto& [name, line] : fake_gpio().chips[kChip].lines) line.fails_with = ENODEV;
  }
  static void come() {
    fake_gpio().chips[kChip].name = "gpiochip0";
    for (auto& [name, line] : fake_gpio().chips[kChip].lines) {
      line.fails_with = 0;
      line.requested = false;
    }
  }
  static std::string lit() {
    std::string levels;
    for (const char* name : kNames) levels += line(name).level ? '1' : '0';
    return levels;
  }

  std::unique_ptr<Lines> lines() {
    return reopened_lines(
        [this] {
          ++tries_;
          return open_gpio(settings_, "adit-panel");
        },
        [this] { return std::make_unique<WatchedLines>(stand_in_); }, [this] { return now_; });
  }
  /// The result of setting the lines each half second.
  std::string set_for(Lines& lines, std::chrono::milliseconds length) {
    std::expected<void, std::string> done;
    for (const Instant end = now_ + length; now_ < end; now_ += 500ms) done = lines.set(kWell);
    return done ? "" : done.error();
  }
  std::unique_ptr<ButtonLine> button() {
    auto made = reopened_button([this] { return open_gpio_button(settings_, "adit-panel"); }, kPace);
    EXPECT_TRUE(made) << made.error();
    return std::move(*made);
  }
  static bool is_readable_soon(const ButtonLine& button) {
    pollfd wanted{.fd = button.descriptor(), .events = POLLIN, .revents = 0};
    return poll(&wanted, 1, 30'000) == 1;
  }
  /// Reads the button only when its descriptor is readable, as its user does.
  static std::expected<bool, std::string> read_level(ButtonLine& button) {
    EXPECT_TRUE(is_readable_soon(button));
    return button.is_pressed();
  }

  static constexpr std::chrono::milliseconds kPace{20};
  loop::FileDescriptor edges_{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  settings::Panel settings_{.chip = "gpiochip0",
                            .health = "HEALTH",
                            .scoring = "SCORING",
                            .mapping = "MAPPING",
                            .attention = "ATTENTION",
                            .button = "BUTTON"};
  WatchedLines::Seen stand_in_;
  Instant now_ = Instant{} + 1h;
  int tries_ = 0;
};

TEST_F(ReopenedChip, LinesOfALostChipAreReopened) {
  const auto held = lines();
  EXPECT_EQ(set_for(*held, 5s), "");
  EXPECT_EQ(tries_, 1);
  EXPECT_EQ(lit(), "1110");
  vanish();
  EXPECT_THAT(set_for(*held, kReopen), HasSubstr("line HEALTH (health) of chip gpiochip0: No such device"));
  EXPECT_EQ(set_for(*held, 10s), "panel: chip gpiochip0: No such file or directory");
  EXPECT_EQ(tries_, 1 + 10s / kReopen);
  EXPECT_EQ(stand_in_.shown.back(), kWell);
  EXPECT_EQ(fake_gpio().open, 0);
  for (const char* name : kNames) line(name).level = false;
  come();
  EXPECT_EQ(set_for(*held, kReopen), "");
  EXPECT_EQ(lit(), "1110");
}

TEST_F(ReopenedChip, LinesOfALateChipAreOpened) {
  vanish();
  const auto held = lines();
  EXPECT_EQ(set_for(*held, 1s), "panel: chip gpiochip0: No such file or directory");
  come();
  EXPECT_EQ(set_for(*held, kReopen), "");
  EXPECT_EQ(lit(), "1110");
}

TEST_F(ReopenedChip, LinesThatFailBrieflyAreKept) {
  const auto held = lines();
  EXPECT_EQ(set_for(*held, 1s), "");
  for (int i = 0; i < 3; ++i) {
    line("MAPPING").fails_with = EIO;
    EXPECT_THAT(set_for(*held, 1500ms), HasSubstr("line MAPPING"));
    line("MAPPING").fails_with = 0;
    EXPECT_EQ(set_for(*held, 500ms), "");
  }
  EXPECT_EQ(tries_, 1);
}

TEST_F(ReopenedChip, LostButtonIsNoticedUntouchedAndReopened) {
  const auto held = button();
  EXPECT_EQ(held->is_pressed(), false);
  const int descriptor = held->descriptor();
  vanish();
  EXPECT_EQ(read_level(*held).error(), "panel: line BUTTON (button) of chip gpiochip0: No such device");
  EXPECT_EQ(read_level(*held).error(), "panel: chip gpiochip0: No such file or directory");
  come();
  EXPECT_EQ(read_level(*held), false);
  line("BUTTON").level = false;
  eventfd_write(edges_.get(), 1);
  EXPECT_EQ(read_level(*held), true);
  EXPECT_EQ(held->descriptor(), descriptor);
}

TEST_F(ReopenedChip, BrieflyLostButtonCountsAsLost) {
  const auto held = button();
  line("BUTTON").level = false;
  EXPECT_EQ(held->is_pressed(), true);
  line("BUTTON").fails_with = EIO;
  EXPECT_FALSE(held->is_pressed().has_value());
  line("BUTTON").fails_with = 0;
  EXPECT_FALSE(held->is_pressed().has_value()) << "the button is opened again too early";
  EXPECT_EQ(read_level(*held), true);
}

TEST_F(ReopenedChip, ButtonOfALateChipIsOpened) {
  vanish();
  const auto held = button();
  EXPECT_EQ(read_level(*held).error(), "panel: chip gpiochip0: No such file or directory");
  come();
  EXPECT_EQ(read_level(*held), false);
}

TEST_F(ReopenedChip, NamedLinesOfALateChipAreHeld) {
  vanish();
  const PanelDevices held = hold(settings_, "adit-panel", "", [](const std::string& why) { FAIL() << why; });
  EXPECT_EQ(held.lines->set(kWell).error(), "panel: chip gpiochip0: No such file or directory");
  EXPECT_FALSE(held.button->is_pressed().has_value());
  settings_.button = "";
  EXPECT_EQ(hold(settings_, "adit-panel", "", {}).button, nullptr);
  EXPECT_EQ(hold({}, "adit-panel", "", {}).lines, nullptr);
}

}  // namespace
}  // namespace adit::panel
