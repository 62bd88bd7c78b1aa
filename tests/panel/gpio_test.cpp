#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

#include "panel/fake_gpiod.hpp"
#include "panel/panel.hpp"

namespace adit::panel {
namespace {

using testing::HasSubstr;

class Gpio : public testing::Test {
 protected:
  Gpio() {
    fake_chip() = {};
    for (const std::string name : {"HEALTH", "SCORING", "MAPPING", "ATTENTION"}) fake_chip().lines[name];
    settings_ = {"gpiochip0", "HEALTH", "SCORING", "MAPPING", "ATTENTION", false};
  }
  static bool level(const std::string& line) { return fake_chip().lines.at(line).level; }
  settings::Panel settings_;
};

TEST_F(Gpio, SetsEachLightsOwnLine) {
  const auto lines = open_gpio(settings_);
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
  EXPECT_EQ(fake_chip().lines.at("HEALTH").consumer, "aditd");
}

TEST_F(Gpio, DrivesALineLowToLightItWhereTheSettingsSaySo) {
  settings_.active_low = true;
  const auto lines = open_gpio(settings_);
  ASSERT_TRUE(lines.has_value()) << lines.error();
  EXPECT_TRUE(level("HEALTH")) << "dark at first";
  ASSERT_TRUE((*lines)->set({true, false, false, false}).has_value());
  EXPECT_FALSE(level("HEALTH"));
  EXPECT_TRUE(level("SCORING"));
}

TEST_F(Gpio, LetsAllLinesGoDarkAtTheEnd) {
  for (const bool active_low : {false, true}) {
    settings_.active_low = active_low;
    {
      const auto lines = open_gpio(settings_);
      ASSERT_TRUE(lines.has_value()) << lines.error();
      ASSERT_TRUE((*lines)->set({true, true, true, true}).has_value());
    }
    for (const auto& [name, line] : fake_chip().lines) {
      EXPECT_EQ(line.level, active_low) << name;
      EXPECT_FALSE(line.requested) << name;
    }
    EXPECT_EQ(fake_chip().open, 0);
    EXPECT_EQ(fake_chip().history.back(), "close") << "a line must not be touched after its chip is closed";
  }
}

TEST_F(Gpio, LeavesOutALightWithoutALine) {
  settings_.scoring = "";
  const auto lines = open_gpio(settings_);
  ASSERT_TRUE(lines.has_value()) << lines.error();
  ASSERT_TRUE((*lines)->set({true, true, true, true}).has_value());
  EXPECT_FALSE(fake_chip().lines.at("SCORING").requested);
  EXPECT_TRUE(level("MAPPING"));
}

TEST_F(Gpio, NamesALineThatTheChipDoesNotHaveAndLetsTheOthersGo) {
  settings_.mapping = "MAPING";
  const auto lines = open_gpio(settings_);
  ASSERT_FALSE(lines.has_value());
  EXPECT_EQ(lines.error(), "panel: line MAPING (mapping) of chip gpiochip0: No such file or directory");
  EXPECT_FALSE(fake_chip().lines.at("HEALTH").requested);
  EXPECT_EQ(fake_chip().open, 0);
}

TEST_F(Gpio, NamesALineThatSomebodyElseHas) {
  fake_chip().lines.at("ATTENTION").requested = true;
  const auto lines = open_gpio(settings_);
  ASSERT_FALSE(lines.has_value());
  EXPECT_EQ(lines.error(), "panel: line ATTENTION (attention) of chip gpiochip0: Device or resource busy");
  EXPECT_TRUE(fake_chip().lines.at("ATTENTION").requested) << "what is another's is left alone";
}

TEST_F(Gpio, SetsTheOtherLightsWhereOneFails) {
  const auto lines = open_gpio(settings_);
  ASSERT_TRUE(lines.has_value()) << lines.error();
  fake_chip().lines.at("HEALTH").fails_with = EIO;
  const auto set = (*lines)->set({true, true, true, true});
  ASSERT_FALSE(set.has_value());
  EXPECT_THAT(set.error(), HasSubstr("line HEALTH (health) of chip gpiochip0: Input/output error"));
  EXPECT_TRUE(level("ATTENTION"));
}

}  // namespace
}  // namespace adit::panel
