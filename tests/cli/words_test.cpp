#include <gtest/gtest.h>

#include <limits>

#include "cli/table.hpp"

namespace adit::cli {
namespace {

TEST(Words, ShowATimeInItsUnit) {
  EXPECT_EQ(duration(-1), "0 s");
  EXPECT_EQ(duration(0.44), "0.4 s");
  EXPECT_EQ(duration(9.96), "10 s");
  EXPECT_EQ(duration(42.3), "42 s");
  EXPECT_EQ(duration(99.6), "2 min");
  EXPECT_EQ(duration(1800), "30 min");
  EXPECT_EQ(duration(7200), "2 h");
  EXPECT_EQ(duration(1e300), duration(1e9));
}

TEST(Words, ShowARunClock) {
  EXPECT_EQ(clock(0), "0:00");
  EXPECT_EQ(clock(754.9), "12:34");
  EXPECT_EQ(clock(3723), "1:02:03");
  EXPECT_EQ(clock(-5), "0:00");
}

TEST(Words, OmitNeedlessDigits) {
  EXPECT_EQ(decimal(12.5, 2), "12.5");
  EXPECT_EQ(decimal(100, 1), "100");
  EXPECT_EQ(decimal(-0.001, 2), "0");
  EXPECT_EQ(decimal(-3.14159, 2), "-3.14");
  EXPECT_EQ(decimal(std::numeric_limits<double>::max(), 2).size(), 309u);
}

TEST(Words, AreColouredOnlyIfSupported) {
  EXPECT_EQ(paint("NO", Tone::Bad, false), "NO");
  EXPECT_EQ(paint("NO", Tone::Bad, true), "\033[1;31mNO\033[0m");
  EXPECT_EQ(paint("yes", Tone::Plain, true), "yes");
  EXPECT_EQ(paint("", Tone::Bad, true), "");
}

}  // namespace
}  // namespace adit::cli
