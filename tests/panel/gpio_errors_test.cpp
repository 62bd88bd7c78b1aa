#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "panel/lines.hpp"

namespace adit::panel {
namespace {

using testing::StartsWith;

// Uses the real libgpiod.

settings::Panel panel_at(const std::string& chip) {
  settings::Panel settings;
  settings.chip = chip;
  settings.health = "HEALTH";
  return settings;
}

TEST(OpenGpio, NamesAMissingChip) {
  for (const std::string chip : {"no-such-chip", "/dev/gpiochip-none"}) {
    const auto lines = open_gpio(panel_at(chip), "aditd");
    ASSERT_FALSE(lines.has_value());
    EXPECT_EQ(lines.error(), "panel: chip " + chip + ": No such file or directory");
  }
}

TEST(OpenGpio, NamesADeviceThatIsNoChip) {
  const auto lines = open_gpio(panel_at("/dev/null"), "aditd");
  ASSERT_FALSE(lines.has_value());
  EXPECT_THAT(lines.error(), StartsWith("panel: chip /dev/null: "));
}

}  // namespace
}  // namespace adit::panel
