#include <gtest/gtest.h>

#include "access/accounts.hpp"

namespace adit::access {
namespace {

using namespace std::chrono_literals;

TEST(Window, IsOpenForItsLength) {
  const Instant start{};
  Window window;
  EXPECT_EQ(window.remaining(start), std::nullopt);
  window.open(start, 10min);
  EXPECT_EQ(window.remaining(start), Duration(10min));
  EXPECT_EQ(window.remaining(start + 10min - 1ns), Duration(1ns));
  EXPECT_EQ(window.remaining(start + 10min), std::nullopt);
  EXPECT_EQ(window.remaining(start + 24h), std::nullopt);
}

TEST(Window, IsClosedByItsUse) {
  Window window;
  window.open(Instant{}, 10min);
  window.close();
  EXPECT_EQ(window.remaining(Instant{} + 1s), std::nullopt);
}

TEST(Window, RestartsIfOpenedAgain) {
  Window window;
  window.open(Instant{}, 10min);
  window.open(Instant{} + 9min, 10min);
  EXPECT_EQ(window.remaining(Instant{} + 11min), Duration(8min));
}

}  // namespace
}  // namespace adit::access
