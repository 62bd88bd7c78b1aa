#include "access/failures.hpp"

#include <gtest/gtest.h>

#include <random>

namespace adit::access {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart{1000h};

TEST(Failures, LeaveFiveTriesFree) {
  Failures failures;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(failures.begin("10.0.0.5", kStart), 0s) << i;
  EXPECT_EQ(failures.begin("10.0.0.5", kStart), 1s);
  EXPECT_EQ(failures.begin("10.0.0.6", kStart), 0s) << "another address";
}

TEST(Failures, DoubleTheWaitUpToAMinute) {
  Failures failures;
  for (int i = 0; i < 5; ++i) (void)failures.begin("10.0.0.5", kStart);
  Instant now = kStart;
  for (const auto wait : {1s, 2s, 4s, 8s, 16s, 32s, 60s, 60s}) {
    EXPECT_EQ(failures.begin("10.0.0.5", now), wait);
    EXPECT_EQ(failures.begin("10.0.0.5", now + wait - 1ns), 1ns) << "being told to wait costs nothing";
    now += wait;
    EXPECT_EQ(failures.begin("10.0.0.5", now), 0s);
  }
}

TEST(Failures, AreForgivenByARightPassword) {
  Failures failures;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(failures.begin("10.0.0.5", kStart), 0s);
  failures.succeeded("10.0.0.5");
  for (int i = 0; i < 5; ++i) EXPECT_EQ(failures.begin("10.0.0.5", kStart), 0s);
  EXPECT_GT(failures.begin("10.0.0.5", kStart), 0s);
}

TEST(Failures, OfAllAddressesTogetherCountToo) {
  Failures failures;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(failures.begin("10.0.0." + std::to_string(i), kStart), 0s);
  EXPECT_EQ(failures.begin("10.0.1.1", kStart), 1s);
  EXPECT_EQ(failures.begin("10.0.1.1", kStart + 1s), 0s);
  EXPECT_EQ(failures.begin("10.0.1.2", kStart + 1s), 2s);
}

TEST(Failures, CannotBeWipedAwayByWhoKnowsOneOfThePasswords) {
  Failures failures;
  Instant now = kStart;
  int guesses = 0;
  while (now < kStart + 1h) {  // four guesses, then one right password, over and over
    for (int i = 0; i < 5; ++i) {
      while (failures.begin("10.0.0.5", now) > 0s) now += 1s;
      ++guesses;
    }
    failures.succeeded("10.0.0.5");
    --guesses;
    now += 10ms;
  }
  EXPECT_LT(guesses, 120);
}

TEST(Failures, AreForgottenAfterAQuietQuarterOfAnHour) {
  Failures failures;
  for (int i = 0; i < 5; ++i) (void)failures.begin("10.0.0.5", kStart);
  EXPECT_GT(failures.begin("10.0.0.5", kStart), 0s);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(failures.begin("10.0.0.5", kStart + 15min), 0s);
}

/// However many addresses and however many at once: a day of guessing gets nowhere near a code of 8 digits.
TEST(Failures, LetNobodyGuessQuickly) {
  std::mt19937_64 random{7};
  Failures failures;
  int tries = 0;
  for (auto now = kStart; now < kStart + 24h; now += 1s) {
    for (int i = 0; i < 10; ++i) {
      if (failures.begin("fd00::" + std::to_string(random() % 100000), now) == 0s) ++tries;
    }
  }
  EXPECT_LT(tries, 24 * 60 + 40);
}

}  // namespace
}  // namespace adit::access
