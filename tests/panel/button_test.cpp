#include "panel/button.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace adit::panel {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;
using Phase = Button::Phase;
using Presses = std::vector<Press>;

constexpr milliseconds kEver{1'000'000};

/// A button whose loop is never late: it is called at each change and at each deadline.
class HeldButton : public testing::Test {
 protected:
  explicit HeldButton(bool pressed = false) : button(pressed, Instant{}) {}

  /// Advances time to `at`.
  void until(milliseconds at) {
    while (button.next() && *button.next() <= Instant(at)) take(button.advance(*button.next()));
  }
  void level(bool pressed, milliseconds at) {
    until(at - 1ms);
    take(button.level(pressed, Instant(at)));
    take(button.advance(Instant(at)));
  }
  void take(std::optional<Press> press) {
    if (press) presses.push_back(*press);
  }
  static Presses of(milliseconds length) {
    HeldButton held;
    held.level(true, 1s);
    held.level(false, 1s + length);
    held.until(kEver);
    return held.presses;
  }
  void TestBody() override {}

  Button button;
  Presses presses;
};

TEST_F(HeldButton, ActsByItsLengthAtEachBoundary) {
  struct Case {
    milliseconds length;
    Presses presses;
  };
  const Case kCases[] = {
      {30ms, {Press::Identify}},
      {1s, {Press::Identify}},
      {2999ms, {Press::Identify}},
      {3000ms, {Press::ShowAddress}},
      {5999ms, {Press::ShowAddress}},
      {6000ms, {}},
      {9999ms, {}},
      {10'001ms, {Press::Reset}},
      {60s, {Press::Reset}},
  };
  for (const Case& row : kCases) EXPECT_EQ(of(row.length), row.presses) << row.length.count();
}

TEST_F(HeldButton, IgnoresABounce) {
  EXPECT_EQ(of(29ms), Presses{});
  for (int ms = 0; ms < 200; ms += 5) level(ms % 10 == 0, 1s + milliseconds(ms));
  until(kEver);
  EXPECT_EQ(presses, Presses{});
  EXPECT_EQ(button.phase(), Phase::Idle);
}

TEST_F(HeldButton, IsOnePressDespiteBounces) {
  for (const auto& [pressed, at] : std::vector<std::pair<bool, milliseconds>>{{true, 1000ms},
                                                                              {false, 1003ms},
                                                                              {true, 1005ms},
                                                                              {false, 1011ms},
                                                                              {true, 1012ms},
                                                                              {false, 2500ms},
                                                                              {true, 2502ms},
                                                                              {false, 2507ms},
                                                                              {true, 2520ms},
                                                                              {false, 2521ms}}) {
    level(pressed, at);
  }
  until(kEver);
  EXPECT_EQ(presses, Presses{Press::Identify});
}

TEST_F(HeldButton, ContinuesIfItsContactOpensBriefly) {
  level(true, 1s);
  level(false, 5s);
  level(true, 5s + 20ms);
  until(11s);
  EXPECT_EQ(presses, Presses{Press::Reset});
}

TEST_F(HeldButton, ShowsTheEffectOfARelease) {
  level(true, 1s);
  until(1s + 30ms);
  EXPECT_EQ(button.phase(), Phase::Pressed);
  until(3999ms);
  EXPECT_EQ(button.phase(), Phase::Pressed);
  until(4s);
  EXPECT_EQ(button.phase(), Phase::Held);
  until(6999ms);
  EXPECT_EQ(button.phase(), Phase::Held);
  until(7s);
  EXPECT_EQ(button.phase(), Phase::Warning);
  until(10'999ms);
  EXPECT_EQ(button.phase(), Phase::Warning);
  EXPECT_EQ(presses, Presses{});
  until(11s);
  EXPECT_EQ(presses, Presses{Press::Reset});
  EXPECT_EQ(button.phase(), Phase::Ignored);
}

TEST_F(HeldButton, ResetsOnce) {
  level(true, 1s);
  until(kEver);
  EXPECT_EQ(presses, Presses{Press::Reset});
  EXPECT_EQ(button.next(), std::nullopt) << "no deadline until the release";
  level(false, kEver);
  until(2 * kEver);
  EXPECT_EQ(presses.size(), 1u);
  level(true, 3 * kEver);
  level(false, 3 * kEver + 100ms);
  until(4 * kEver);
  EXPECT_EQ(presses.back(), Press::Identify) << "the button works again";
}

class StuckButton : public HeldButton {
 protected:
  StuckButton() : HeldButton(true) {}
};

TEST_F(StuckButton, DoesNothingUntilReleased) {
  until(kEver);
  EXPECT_EQ(presses, Presses{});
  EXPECT_EQ(button.phase(), Phase::Ignored);
  level(false, kEver);
  until(kEver + 1s);
  EXPECT_EQ(presses, Presses{});
  level(true, kEver + 2s);
  level(false, kEver + 6s);
  until(2 * kEver);
  EXPECT_EQ(presses, Presses{Press::ShowAddress});
}

TEST_F(StuckButton, StaysStuckAfterABounce) {
  level(false, 1s);
  level(true, 1s + 10ms);
  until(kEver);
  EXPECT_EQ(presses, Presses{});
  EXPECT_EQ(button.phase(), Phase::Ignored);
}

// The loop is late.

TEST(LateButton, DoesNotResetByALateRelease) {
  Button button(false, Instant{});
  button.level(true, Instant(1s));
  button.advance(Instant(1s + 30ms));
  EXPECT_EQ(button.level(false, Instant(15s)), std::nullopt) << "the time of the release is unknown";
  EXPECT_EQ(button.advance(Instant(15s)), std::nullopt);
  EXPECT_EQ(button.advance(Instant(15s + 30ms)), std::nullopt);
  EXPECT_EQ(button.phase(), Phase::Idle);
}

TEST(LateButton, DoesNotResetWhileAReleaseMayBeABounce) {
  Button button(false, Instant{});
  button.level(true, Instant(1s));
  button.advance(Instant(10s));
  EXPECT_EQ(button.phase(), Phase::Warning);
  button.level(false, Instant(10'990ms));
  EXPECT_EQ(button.advance(Instant(11'001ms)), std::nullopt);
  EXPECT_EQ(button.advance(Instant(11'020ms)), std::nullopt);
  EXPECT_EQ(button.phase(), Phase::Idle);
}

TEST(LateButton, SettlesALastingLevelBeforeTheNext) {
  Button button(false, Instant{});
  button.level(true, Instant(1s));
  button.level(false, Instant(2s));
  EXPECT_EQ(button.level(true, Instant(3s)), Press::Identify);
}

}  // namespace
}  // namespace adit::panel
