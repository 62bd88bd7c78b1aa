#include <gtest/gtest.h>

#include "forward/flow.hpp"

namespace adit::forward {
namespace {

TEST(MeterTest, ShowsZeroInTheFirstSecond) {
  Meter meter;
  EXPECT_EQ(meter.mbit(), 0);
  meter.on_second(1'000'000);
  EXPECT_EQ(meter.mbit(), 0);
}

TEST(MeterTest, ShowsTheMeanOfTheLastSeconds) {
  Meter meter;
  meter.on_second(7);
  meter.on_second(7 + 1'000'000);
  EXPECT_DOUBLE_EQ(meter.mbit(), 8);
  for (std::size_t i = 1; i < Meter::kSeconds; ++i) meter.on_second(7 + 1'000'000);
  EXPECT_DOUBLE_EQ(meter.mbit(), 8.0 / Meter::kSeconds);
  meter.on_second(7 + 1'000'000);
  EXPECT_DOUBLE_EQ(meter.mbit(), 0);
}

}  // namespace
}  // namespace adit::forward
