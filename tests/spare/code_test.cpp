#include "spare/code.hpp"

#include <gtest/gtest.h>

namespace adit::spare {
namespace {

TEST(Code, IsOfSixteenDigitsWhateverIsDrawn) {
  std::array<std::uint8_t, kCodeDigits> random{};
  EXPECT_EQ(draw_code(random), "0000000000000000");
  random.fill(0xff);
  EXPECT_EQ(draw_code(random), "5541128671347064") << "2^128 - 1, from its last digit on";
}

TEST(Code, IsSpokenInGroupsAndTypedAsOneLikes) {
  EXPECT_EQ(spoken("1234567890123456"), "1234 5678 9012 3456");
  for (const char* const typed : {"1234567890123456", "1234 5678 9012 3456", "1234-5678-9012-3456 "})
    EXPECT_EQ(code_in(typed), "1234567890123456") << typed;
  for (const char* const wrong : {"", "123456789012345", "12345678901234567", "1234567890123x56", "１234"})
    EXPECT_FALSE(code_in(wrong)) << wrong;
}

}  // namespace
}  // namespace adit::spare
