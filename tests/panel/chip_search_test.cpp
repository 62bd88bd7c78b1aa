// The search for lines and chips, which libgpiod 2 does not offer.
#include <gtest/gtest.h>

#include <cerrno>

#include "panel/fake_gpiod.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

class ChipSearch : public testing::Test {
 protected:
  ChipSearch() {
    fake_gpio() = {};
    fake_gpio().chips["/dev/gpiochip0"] = {
        .name = "gpiochip0", .label = "", .opens_with = EACCES, .lines = {}};
    fake_gpio().chips["/dev/gpiochip1"] = {.name = "gpiochip1", .label = "", .lines = {{"OTHER", {}}}};
    fake_gpio().chips["/dev/gpiochip2"] = {.name = "gpiochip2", .label = "leds", .lines = {{"HEALTH", {}}}};
  }
  static std::string open_health_of(const std::string& chip, const std::string& line = "HEALTH") {
    settings::Panel settings;
    settings.chip = chip;
    settings.health = line;
    const auto lines = open_gpio(settings, "aditd");
    return lines ? "" : lines.error();
  }
};

TEST_F(ChipSearch, SkipsAnUnopenableChip) {
  for (const std::string chip : {"", "gpiochip2", "leds"}) EXPECT_EQ(open_health_of(chip), "") << chip;
}

TEST_F(ChipSearch, NamesAnUnopenableChipIfNoOtherFits) {
  EXPECT_EQ(open_health_of("", "HELTH"),
            "panel: line HELTH (health) of any chip: /dev/gpiochip0: Permission denied");
  EXPECT_EQ(open_health_of("gpiochip0"), "panel: chip gpiochip0: /dev/gpiochip0: Permission denied");
  EXPECT_EQ(open_health_of("lights"), "panel: chip lights: /dev/gpiochip0: Permission denied");
  fake_gpio().chips["/dev/gpiochip0"].opens_with = 0;
  EXPECT_EQ(open_health_of("lights"), "panel: chip lights: No such file or directory");
}

TEST_F(ChipSearch, ReportsThatChipsCannotBeListed) {
  fake_gpio().lists_with = EACCES;
  EXPECT_EQ(open_health_of("leds"), "panel: chip leds: /dev: Permission denied");
  EXPECT_EQ(open_health_of(""), "panel: line HEALTH (health) of any chip: /dev: Permission denied");
}

}  // namespace
}  // namespace adit::panel
