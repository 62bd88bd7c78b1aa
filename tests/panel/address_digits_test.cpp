#include <gtest/gtest.h>

#include <string>

#include "panel/states.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;

/// The digits that a user counts: one for each group of short flashes, a dot for a long flash.
std::string counted(const std::vector<Step>& steps) {
  std::string text;
  int flashes = 0;
  for (const Step& step : steps) {
    if (step.lit && step.length >= 800ms) {
      text += '.';
    } else if (step.lit) {
      ++flashes;
    } else if (step.length >= 1s && flashes > 0) {
      text += std::to_string(flashes % 10);
      flashes = 0;
    }
  }
  return text;
}

TEST(AddressDigits, CanBeCountedTwice) {
  for (const std::string address : {"10.0.0.1", "192.168.108.90", "255.255.255.255"}) {
    EXPECT_EQ(counted(address_digits(address)), address + address);
  }
}

TEST(AddressDigits, BeginAndEndDark) {
  const auto steps = address_digits("10.0.0.1");
  EXPECT_FALSE(steps.front().lit);
  EXPECT_FALSE(steps.back().lit);
  for (std::size_t i = 1; i < steps.size(); ++i) EXPECT_TRUE(!steps[i].lit || !steps[i - 1].lit) << i;
}

TEST(AddressDigits, EndSoon) {
  EXPECT_LT(length_of(address_digits("10.0.0.1")), 1min);
  EXPECT_LT(length_of(address_digits("192.168.108.90")), 3min);
}

TEST(AddressDigits, OfAnInvalidAddressAreDark) {
  for (const Step& step : address_digits("fe80::")) EXPECT_TRUE(!step.lit || step.length == 200ms);
  EXPECT_EQ(counted(address_digits("")), "");
}

}  // namespace
}  // namespace adit::panel
