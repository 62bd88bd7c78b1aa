#include "access/set_up_window.hpp"

#include <gtest/gtest.h>

namespace adit::access {
namespace {

using namespace std::chrono_literals;

TEST(SetUpWindow, IsOpenForTenMinutesOnceItWasOpened) {
  const Instant start{};
  SetUpWindow window;
  EXPECT_EQ(window.left(start), std::nullopt);
  window.open(start);
  EXPECT_EQ(window.left(start), Duration(10min));
  EXPECT_EQ(window.left(start + 10min - 1ns), Duration(1ns));
  EXPECT_EQ(window.left(start + 10min), std::nullopt);
  EXPECT_EQ(window.left(start + 24h), std::nullopt);
}

TEST(SetUpWindow, IsClosedByItsUse) {
  SetUpWindow window;
  window.open(Instant{});
  window.close();
  EXPECT_EQ(window.left(Instant{} + 1s), std::nullopt);
}

TEST(SetUpWindow, CountsAnewWhenItIsOpenedAgain) {
  SetUpWindow window;
  window.open(Instant{});
  window.open(Instant{} + 9min);
  EXPECT_EQ(window.left(Instant{} + 11min), Duration(8min));
}

}  // namespace
}  // namespace adit::access
