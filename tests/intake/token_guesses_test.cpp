#include <gtest/gtest.h>

#include "intake/turnstile.hpp"

namespace adit::intake {
namespace {

using namespace std::chrono_literals;
using TokenCheck = TokenGuesses::TokenCheck;

constexpr loop::Instant kBegin{100h};
const TokenGuesses::Verdict kAdmitted{TokenCheck::Right, false}, kUnchecked{TokenCheck::NotChecked, true};

class TokenGuessesTest : public testing::Test {
 protected:
  /// A new guess. True if it was checked.
  bool guess(const std::string& address, loop::Instant now) {
    return guesses_.wrong(address, "guess " + std::to_string(++guessed_), now).looked == TokenCheck::Wrong;
  }
  void guess_often(const std::string& address, int times, loop::Instant now) {
    for (int i = 0; i < times; ++i) guess(address, now);
  }
  TokenGuesses guesses_;
  int guessed_ = 0;
};

TEST_F(TokenGuessesTest, AreCheckedOnceASecondAfterAFew) {
  for (int i = 0; i < TokenGuesses::kFree; ++i) EXPECT_TRUE(guess("10.0.0.9", kBegin)) << i;
  int looked_at = 0;
  for (auto after = 0ms; after < 60s; after += 1ms) looked_at += guess("10.0.0.9", kBegin + after) ? 1 : 0;
  EXPECT_EQ(looked_at, 59);
  EXPECT_EQ(guesses_.wrong("10.0.0.9", "another", kBegin + 60s - 1ms), kUnchecked);
}

TEST_F(TokenGuessesTest, DoNotDelayAnotherAddress) {
  guess_often("10.0.0.9", 10'000, kBegin);
  EXPECT_EQ(guesses_.right("10.0.0.5", kBegin), kAdmitted);
  EXPECT_EQ(guesses_.wrong("10.0.0.6", "old", kBegin), (TokenGuesses::Verdict{TokenCheck::Wrong, false}));
}

TEST_F(TokenGuessesTest, DoNotDelayAnAuthenticatedAddress) {
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin), kAdmitted);
  for (int i = 0; i < 1000; ++i) {
    guess("10.0.0.9", kBegin + i * 1ms);
    EXPECT_EQ(guesses_.right("10.0.0.9", kBegin + i * 1ms), kAdmitted);
  }
}

TEST_F(TokenGuessesTest, DelayARightTokenUntilTheyAreFew) {
  guess_often("10.0.0.9", 1000, kBegin);
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin), kUnchecked) << "like a wrong one";
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin + 1s), kAdmitted) << "soon after the last guess";
  guess_often("10.0.0.9", 1000, kBegin + 1s);
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin + 1s), kAdmitted) << "now authenticated";
}

TEST_F(TokenGuessesTest, DoNotIncludeARepeatedOldToken) {
  for (int i = 0; i < 1000; ++i) {
    const TokenGuesses::Verdict verdict =
        guesses_.wrong("10.0.0.9", i % 2 == 0 ? "old" : "", kBegin + i * 10ms);
    EXPECT_EQ(verdict.looked, TokenCheck::Wrong) << i;
    EXPECT_EQ(verdict.late, i >= TokenGuesses::kFree && i % 100 != 0) << i;
  }
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin + 10s), kAdmitted) << "another robot behind the same router";
}

TEST_F(TokenGuessesTest, AreForgottenIfTheTokensChange) {
  guess_often("10.0.0.9", 1000, kBegin);
  guesses_.forget();
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin), kAdmitted);
}

TEST_F(TokenGuessesTest, OfManyAddressesForgetNoAuthenticatedOne) {
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin), kAdmitted);
  guess_often("10.0.0.9", 1000, kBegin);
  for (int i = 0; i < 10'000; ++i) guess(std::to_string(i), kBegin + 1ms);
  EXPECT_EQ(guesses_.right("10.0.0.9", kBegin + 1ms), kAdmitted);
  EXPECT_EQ(guesses_.right("10.0.0.5", kBegin + 1ms), kAdmitted) << "nor delay a new address";
}

}  // namespace
}  // namespace adit::intake
