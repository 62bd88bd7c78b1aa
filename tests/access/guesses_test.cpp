#include "access/guesses.hpp"

#include <gtest/gtest.h>

#include <random>

#include "access/start.hpp"

namespace adit::access {
namespace {

using namespace std::chrono_literals;

constexpr Wait kAtOnce{};

const Guesser kOne{.address = "10.0.0.5"};

Guesser stranger(std::uint64_t number) {
  return {.address = "10.1." + std::to_string(number / 256) + '.' + std::to_string(number % 256)};
}

constexpr Wait pause(Duration left) {
  return {left, false};
}

constexpr Wait turn(Duration left) {
  return {left, true};
}

TEST(Guesses, FiveAreFree) {
  Guesses guesses;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(guesses.begin(kOne, kStart), kAtOnce) << i;
  EXPECT_EQ(guesses.begin(kOne, kStart), pause(1s));
  EXPECT_EQ(guesses.begin(stranger(1), kStart + 1s), kAtOnce) << "another address";
}

TEST(Guesses, DoubleTheWaitUpToAMinute) {
  Guesses guesses;
  for (int i = 0; i < 5; ++i) (void)guesses.begin(kOne, kStart);
  Instant now = kStart;
  for (const auto wait : {1s, 2s, 4s, 8s, 16s, 32s, 60s, 60s}) {
    EXPECT_EQ(guesses.begin(kOne, now), pause(wait));
    EXPECT_EQ(guesses.begin(kOne, now + wait - 1ns), pause(1ns)) << "a rejected attempt does not count";
    now += wait;
    EXPECT_EQ(guesses.begin(kOne, now), kAtOnce);
  }
}

TEST(Guesses, AreClearedByTheOperatorsPassword) {
  Guesses guesses;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(guesses.begin(kOne, kStart), kAtOnce);
  guesses.on_succeeded(kOne, Role::Operator);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(guesses.begin(kOne, kStart + 10s), kAtOnce);
  EXPECT_NE(guesses.begin(kOne, kStart + 10s), kAtOnce);
}

TEST(Guesses, OfTheOperatorsAreNotClearedByTheViewers) {
  for (const std::uint64_t device : {0, 3}) {
    Guesses guesses;
    const Guesser viewer{.address = "10.0.0.5", .device = device};
    int tries = 0;
    for (Instant now = kStart; now < kStart + 1h; now += 10ms) {  // wrong and right tokens alternate
      if (guesses.begin(viewer, now) != kAtOnce) continue;
      if (++tries % 2 == 0) guesses.on_succeeded(viewer, Role::Viewer);
    }
    EXPECT_LT(tries, 150) << device;
  }
}

TEST(Guesses, AreOneASecondInTotal) {
  std::mt19937_64 random{7};
  Guesses guesses;
  int tries = 0;
  for (auto now = kStart; now < kStart + 20min; now += 100ms) {
    for (int i = 0; i < 10; ++i) tries += guesses.begin(stranger(random() % 60'000), now) == kAtOnce ? 1 : 0;
  }
  EXPECT_LE(tries, 1200 + Guesses::kSaved);
}

/// 120 addresses guess all the time, and one address waits as told.
TEST(Guesses, GiveEachAddressATurnAtAKnownTime) {
  Guesses guesses;
  const auto all_ask = [&](Instant now) {
    for (int i = 0; i < 120; ++i) (void)guesses.begin(stranger(i), now);
  };
  Instant now = kStart;
  for (; now < kStart + 5min; now += 250ms) all_ask(now);
  const Wait told = guesses.begin(kOne, now);
  EXPECT_TRUE(told.for_others);
  EXPECT_GT(told.left, 1s);
  EXPECT_LE(told.left, 121s);
  const Instant its = now + told.left;
  for (; now < its; now += 250ms) {
    all_ask(now);
    EXPECT_EQ(guesses.begin(kOne, now), turn(its - now)) << "another attempt does not change the turn";
  }
  EXPECT_EQ(guesses.begin(kOne, its), kAtOnce);
}

TEST(Guesses, KeepATurnForSomeSeconds) {
  for (const auto late : {Guesses::kLate, Guesses::kLate + 1s}) {
    Guesses guesses;
    for (int i = 0; i < 40; ++i) (void)guesses.begin(stranger(i), kStart);
    const Wait told = guesses.begin(kOne, kStart);
    ASSERT_EQ(told, turn(36s));
    const Instant then = kStart + told.left + late;
    for (int i = 100; i < 200; ++i) (void)guesses.begin(stranger(i), then);
    EXPECT_EQ(guesses.begin(kOne, then) == kAtOnce, late == Guesses::kLate) << late.count();
  }
}

TEST(Guesses, AllowAKnownDeviceAtOnce) {
  Guesses guesses;
  for (Instant now = kStart; now < kStart + 1min; now += 100ms) {
    for (int i = 0; i < 300; ++i) (void)guesses.begin(stranger(i), now);
  }
  const Guesser known{.address = "10.0.0.5", .device = 1};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(guesses.begin(known, kStart + 1min), kAtOnce);
  EXPECT_EQ(guesses.begin(known, kStart + 1min), pause(1s)) << "but it guesses no faster";
  EXPECT_EQ(guesses.begin({.address = "10.0.0.5", .device = 2}, kStart + 1min), kAtOnce) << "another device";
}

TEST(Guesses, AllowAClientAtTheBoxUnlessItGuessedWrong) {
  Guesses guesses;
  for (int i = 0; i < 120; ++i) (void)guesses.begin(stranger(i), kStart);
  EXPECT_TRUE(guesses.begin(kOne, kStart).for_others);
  EXPECT_EQ(guesses.begin({.address = kOne.address, .at_box = true}, kStart), kAtOnce);
  Guesser guessing = stranger(0);
  guessing.at_box = true;
  EXPECT_TRUE(guesses.begin(guessing, kStart).for_others);
}

TEST(Guesses, LimitTheWaitByTheNumberOfGuessers) {
  Guesses guesses;
  for (Instant now = kStart; now < kStart + 10s; now += 10ms) {
    const auto number = static_cast<std::uint64_t>((now - kStart) / 10ms);
    EXPECT_LE(guesses.begin(stranger(number), now).left, 1s * Guesses::kMostGuessers);
  }
}

TEST(Guesses, AreForgottenAfterFifteenQuietMinutes) {
  Guesses guesses;
  for (int i = 0; i < 5; ++i) (void)guesses.begin(kOne, kStart);
  EXPECT_NE(guesses.begin(kOne, kStart), kAtOnce);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(guesses.begin(kOne, kStart + 15min), kAtOnce);
}

}  // namespace
}  // namespace adit::access
