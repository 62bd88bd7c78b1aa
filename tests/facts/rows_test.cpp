#include "facts/rows.hpp"

#include <gtest/gtest.h>

namespace adit::facts {
namespace {

ActivityRow with_ages(ActivityRow row) {
  set_ages(row, 1000);
  return row;
}

TEST(Ages, AreOfTheRobotsDataAndNotOfItsDelivery) {
  EXPECT_EQ(with_ages({.last_accepted = 906, .last_forwarded = 999}).age, 94) << "it was queued for long";
  EXPECT_EQ(with_ages({.last_accepted = 999, .last_forwarded = 980}).age, 20)
      << "the newest is not delivered";
  EXPECT_EQ(with_ages({.last_forwarded = 975}).age, 25);
  EXPECT_EQ(with_ages({.last_accepted = 999}).age, std::nullopt) << "nothing is delivered";
}

TEST(Ages, AreNeverNegative) {
  EXPECT_EQ(with_ages({.last_forwarded = 1010}).age, 0);
  EXPECT_EQ(with_ages({.behind_since = 1010}).behind, 0);
}

TEST(Ages, OfTheQueueAreThoseOfItsOldestMessage) {
  EXPECT_EQ(with_ages({.behind_since = 975}).behind, 25);
  EXPECT_EQ(with_ages({}).behind, std::nullopt);
}

}  // namespace
}  // namespace adit::facts
