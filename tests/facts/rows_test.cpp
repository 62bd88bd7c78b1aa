#include "facts/rows.hpp"

#include <gtest/gtest.h>

namespace adit::facts {
namespace {

ActivityRow with_ages(ActivityRow row) {
  set_ages(row, 1000);
  return row;
}

TEST(Ages, AreThoseOfTheOldestUndeliveredMessage) {
  EXPECT_EQ(with_ages({.behind_since = 975, .last_accepted = 999, .last_forwarded = 998}).age, 25);
  EXPECT_EQ(with_ages({.last_accepted = 999, .last_forwarded = 999}).age, std::nullopt);
}

TEST(Ages, AreHeardFromTheLastMessage) {
  EXPECT_EQ(with_ages({.behind_since = 975, .last_accepted = 999}).heard, 1);
  EXPECT_EQ(with_ages({}).heard, std::nullopt);
}

TEST(Ages, AreNeverNegative) {
  EXPECT_EQ(with_ages({.last_accepted = 1010}).heard, 0);
  EXPECT_EQ(with_ages({.behind_since = 1010}).age, 0);
}

}  // namespace
}  // namespace adit::facts
