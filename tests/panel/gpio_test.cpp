#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

#include "panel/fake_gpiod.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class Gpio : public testing::Test {
 protected:
  Gpio() {
    fake_gpio() = {};
    FakeChip& first = fake_gpio().chips["/dev/gpiochip0"];
    first.name = "gpiochip0";
    first.label = "other";
    first.lines["ELSEWHERE"];
    FakeChip& second = fake_gpio().chips["/dev/gpiochip1"];
    second.name = "gpiochip1";
    second.label = "9030000.pl061";
    for (const std::string name : {"HEALTH", "SCORING", "MAPPING", "ATTENTION", "BUTTON"}) second.lines[name];
    settings_ = {.chip = "gpiochip1",
                 .health = "HEALTH",
                 .scoring = "SCORING",
                 .mapping = "MAPPING",
                 .attention = "ATTENTION",
                 .button = "BUTTON"};
    line("BUTTON").level = true;  // pulled up
  }
  static FakeLine& line(const std::string& name) { return fake_gpio().line(name); }
  static bool level(const std::string& name) { return line(name).level; }
  auto open() const { return open_gpio(settings_, "aditd"); }
  auto open_button() const { return open_gpio_button(settings_, "aditd"); }
  settings::Panel settings_;
};

TEST_F(Gpio, SetsEachLightsOwnLine) {
  const auto lines = open();
  ASSERT_TRUE(lines.has_value()) << lines.error();
  ASSERT_TRUE((*lines)->set({true, false, true, false}).has_value());
  EXPECT_TRUE(level("HEALTH"));
  EXPECT_FALSE(level("SCORING"));
  EXPECT_TRUE(level("MAPPING"));
  EXPECT_FALSE(level("ATTENTION"));
  ASSERT_TRUE((*lines)->set({false, true, false, true}).has_value());
  EXPECT_FALSE(level("HEALTH"));
  EXPECT_TRUE(level("SCORING"));
  EXPECT_FALSE(level("MAPPING"));
  EXPECT_TRUE(level("ATTENTION"));
  EXPECT_EQ(line("HEALTH").consumer, "aditd");
  EXPECT_TRUE(line("HEALTH").output);
}

TEST_F(Gpio, FindsItsChipByNameLabelPathOrLines) {
  for (const std::string chip : {"gpiochip1", "9030000.pl061", "/dev/gpiochip1", ""}) {
    settings_.chip = chip;
    const auto lines = open();
    ASSERT_TRUE(lines.has_value()) << lines.error();
    ASSERT_TRUE((*lines)->set({true, true, true, true}).has_value());
    EXPECT_TRUE(level("HEALTH")) << chip;
    const auto button = open_button();
    ASSERT_TRUE(button.has_value()) << button.error();
    EXPECT_TRUE(line("BUTTON").requested) << chip;
  }
  EXPECT_EQ(fake_gpio().open, 0);
}

TEST_F(Gpio, UsesLinesOfSeveralChipsIfNoneIsNamed) {
  settings_.chip = "";
  settings_.mapping = "ELSEWHERE";
  {
    const auto lines = open();
    ASSERT_TRUE(lines.has_value()) << lines.error();
    ASSERT_TRUE((*lines)->set({true, false, true, false}).has_value());
    EXPECT_TRUE(level("ELSEWHERE"));
    EXPECT_TRUE(level("HEALTH"));
  }
  EXPECT_FALSE(level("ELSEWHERE"));
  EXPECT_EQ(fake_gpio().open, 0);
}

TEST_F(Gpio, DrivesActiveLowLines) {
  settings_.active_low = true;
  const auto lines = open();
  ASSERT_TRUE(lines.has_value()) << lines.error();
  EXPECT_TRUE(level("HEALTH")) << "the light is off at first";
  ASSERT_TRUE((*lines)->set({true, false, false, false}).has_value());
  EXPECT_FALSE(level("HEALTH"));
  EXPECT_TRUE(level("SCORING"));
}

TEST_F(Gpio, IsDarkAtTheEnd) {
  for (const bool active_low : {false, true}) {
    settings_.active_low = active_low;
    {
      const auto lines = open();
      ASSERT_TRUE(lines.has_value()) << lines.error();
      ASSERT_TRUE((*lines)->set({true, true, true, true}).has_value());
    }
    for (const char* name : {"HEALTH", "SCORING", "MAPPING", "ATTENTION"}) {
      EXPECT_EQ(level(name), active_low) << name;
      EXPECT_FALSE(line(name).requested) << name;
    }
    EXPECT_EQ(fake_gpio().open, 0);
  }
}

TEST_F(Gpio, OmitsALightWithoutALine) {
  settings_.scoring = "";
  const auto lines = open();
  ASSERT_TRUE(lines.has_value()) << lines.error();
  ASSERT_TRUE((*lines)->set({true, true, true, true}).has_value());
  EXPECT_FALSE(line("SCORING").requested);
  EXPECT_TRUE(level("MAPPING"));
}

TEST_F(Gpio, NamesAMissingLineAndReleasesTheOthers) {
  settings_.mapping = "MAPING";
  for (const std::string chip : {"gpiochip1", ""}) {
    settings_.chip = chip;
    const auto lines = open();
    ASSERT_FALSE(lines.has_value());
    EXPECT_EQ(lines.error(), "panel: line MAPING (mapping) of " +
                                 (chip.empty() ? std::string("any chip") : "chip " + chip) +
                                 ": No such file or directory");
    EXPECT_FALSE(line("HEALTH").requested);
    EXPECT_EQ(fake_gpio().open, 0);
  }
}

TEST_F(Gpio, NamesAMissingChip) {
  for (const std::string chip : {"gpiochip7", "/dev/gpiochip7", "label"}) {
    settings_.chip = chip;
    EXPECT_EQ(open().error(), "panel: chip " + chip + ": No such file or directory");
    EXPECT_EQ(open_button().error(), "panel: chip " + chip + ": No such file or directory");
  }
}

TEST_F(Gpio, NamesAnUnopenableChipThatMayHaveTheLine) {
  settings_.chip = "";
  fake_gpio().chips["/dev/gpiochip1"].opens_with = EACCES;
  const auto lines = open();
  ASSERT_FALSE(lines.has_value());
  EXPECT_THAT(lines.error(), StartsWith("panel: line HEALTH (health) of any chip: "));
  EXPECT_THAT(lines.error(), EndsWith("Permission denied"));
  settings_.chip = "/dev/gpiochip1";
  EXPECT_EQ(open_button().error(), "panel: chip /dev/gpiochip1: Permission denied");
}

TEST_F(Gpio, NamesALineInUse) {
  line("ATTENTION").requested = true;
  const auto lines = open();
  ASSERT_FALSE(lines.has_value());
  EXPECT_EQ(lines.error(), "panel: line ATTENTION (attention) of chip gpiochip1: Device or resource busy");
  EXPECT_TRUE(line("ATTENTION").requested) << "another program's line must stay requested";
}

TEST_F(Gpio, SetsTheOtherLightsIfOneFails) {
  const auto lines = open();
  ASSERT_TRUE(lines.has_value()) << lines.error();
  line("HEALTH").fails_with = EIO;
  const auto set = (*lines)->set({true, true, true, true});
  ASSERT_FALSE(set.has_value());
  EXPECT_THAT(set.error(), HasSubstr("line HEALTH (health) of chip gpiochip1: Input/output error"));
  EXPECT_TRUE(level("ATTENTION"));
}

TEST_F(Gpio, ReadsTheButtonByItsLevelNotItsEdges) {
  line("BUTTON").descriptor = 7;
  const auto button = open_button();
  ASSERT_TRUE(button.has_value()) << button.error();
  EXPECT_EQ((*button)->descriptor(), 7);
  EXPECT_FALSE(line("BUTTON").output);
  EXPECT_FALSE((*button)->is_pressed().value());
  fake_gpio().drive("BUTTON", false);
  line("BUTTON").events = 40;  // it bounced
  EXPECT_TRUE((*button)->is_pressed().value());
  EXPECT_EQ(line("BUTTON").events, 0) << "remaining events keep the descriptor readable";
  fake_gpio().drive("BUTTON", true);
  EXPECT_FALSE((*button)->is_pressed().value());
}

TEST_F(Gpio, PullsTheButtonToItsReleasedLevel) {
  {
    const auto button = open_button();
    EXPECT_TRUE(line("BUTTON").active_low);
    EXPECT_EQ(line("BUTTON").pull, 1);
  }
  EXPECT_FALSE(line("BUTTON").requested);
  EXPECT_EQ(fake_gpio().open, 0);
  settings_.button_active_low = false;
  const auto button = open_button();
  EXPECT_EQ(line("BUTTON").pull, -1);
  EXPECT_TRUE((*button)->is_pressed().value()) << "the wire is high";
}

TEST_F(Gpio, UsesAButtonOfAChipWithoutPull) {
  fake_gpio().chips["/dev/gpiochip1"].knows_pull = false;
  const auto button = open_button();
  ASSERT_TRUE(button.has_value()) << button.error();
  EXPECT_EQ(line("BUTTON").pull, 0);
}

TEST_F(Gpio, TellsWhyTheButtonFails) {
  line("BUTTON").requested = true;
  EXPECT_EQ(open_button().error(), "panel: line BUTTON (button) of chip gpiochip1: Device or resource busy");
  line("BUTTON").requested = false;
  const auto button = open_button();
  line("BUTTON").fails_with = EIO;
  EXPECT_EQ((*button)->is_pressed().error(),
            "panel: line BUTTON (button) of chip gpiochip1: Input/output error");
  settings_.button = "BUTTN";
  EXPECT_EQ(open_button().error(), "panel: line BUTTN (button) of chip gpiochip1: No such file or directory");
}

}  // namespace
}  // namespace adit::panel
