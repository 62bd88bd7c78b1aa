#include "panel/painter.hpp"

#include <gtest/gtest.h>

#include "panel/watched_lines.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;

constexpr Lit kWell{true, true, true, false}, kOther{true, false, false, true};

class PainterTest : public testing::Test {
 protected:
  PainterTest() { painter_.set_lines(std::make_unique<WatchedLines>(seen_)); }
  /// The levels that were set in `length` while the same lights are shown.
  std::vector<Lit> shown_for(Milliseconds length, const Lit& lit) {
    seen_.shown.clear();
    for (const Instant end = now_ + length; now_ < end; now_ += 50ms) painter_.show(lit, now_);
    return seen_.shown;
  }
  static std::vector<Lit> times(std::size_t count, const Lit& lit) { return std::vector<Lit>(count, lit); }

  WatchedLines::Seen seen_;
  Painter painter_;
  Instant now_ = Instant{} + 1h;
};

TEST_F(PainterTest, SetsChangesAtOnceAndRepeatsTheRest) {
  EXPECT_TRUE(painter_.is_blank());
  EXPECT_EQ(shown_for(Painter::kConfirm, kWell), times(1, kWell));
  EXPECT_FALSE(painter_.is_blank());
  EXPECT_EQ(shown_for(3 * Painter::kConfirm, kWell), times(3, kWell));
  EXPECT_EQ(shown_for(100ms, kOther), times(1, kOther));
  EXPECT_EQ(painter_.trouble(), "");
}

TEST_F(PainterTest, RetriesAFailureAtABoundedPace) {
  shown_for(1s, kWell);
  seen_.fail = true;
  EXPECT_EQ(shown_for(2 * Painter::kAgain, kOther), times(2, kOther));
  EXPECT_EQ(painter_.trouble(), "gpiochip0: gone");
  EXPECT_EQ(painter_.next(), now_);
  seen_.fail = false;
  EXPECT_EQ(shown_for(Painter::kAgain, kOther), times(1, kOther));
}

TEST_F(PainterTest, StaysInTroubleUntilItWorksForAWhile) {
  seen_.fail = true;
  shown_for(1s, kWell);
  seen_.fail = false;
  shown_for(Painter::kMended - 1s, kWell);
  EXPECT_EQ(painter_.trouble(), "gpiochip0: gone");
  seen_.fail = true;
  shown_for(100ms, kOther);
  seen_.fail = false;
  shown_for(Painter::kMended, kWell);
  EXPECT_EQ(painter_.trouble(), "gpiochip0: gone") << "a loose contact is an error";
  shown_for(Painter::kConfirm + Painter::kAgain, kWell);
  EXPECT_EQ(painter_.trouble(), "");
}

TEST_F(PainterTest, ShowsAllOnNewLines) {
  seen_.fail = true;
  shown_for(1s, kWell);
  WatchedLines::Seen other;
  painter_.set_lines(std::make_unique<WatchedLines>(other));
  EXPECT_EQ(painter_.trouble(), "");
  painter_.show(kWell, now_);
  EXPECT_EQ(other.shown, times(1, kWell));
  painter_.set_lines(nullptr);
  painter_.show(kWell, now_);
  EXPECT_EQ(painter_.next(), std::nullopt);
}

}  // namespace
}  // namespace adit::panel
