#include "dispatch/inquiry.hpp"

#include <gtest/gtest.h>

namespace adit::dispatch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Inquiry::Instant at(double s) {
  return Inquiry::Instant{} + milliseconds(static_cast<std::int64_t>(s * 1000));
}

/// An answer was lost at 0 s, with a run clock at 500 s that goes on.
class InquiryTest : public testing::Test {
 protected:
  Finding hear(double now, Finding finding) { return hear(now, finding, 500 + now); }
  Finding hear(double now, Finding finding, double run_clock) { return hear(now, finding, run_clock, now); }
  Finding hear(double now, Finding finding, double run_clock, double asked) {
    return inquiry_.hear({.finding = finding, .why = "", .points_each = std::nullopt}, run_clock, at(asked),
                         at(now));
  }
  /// Each second from `from` to `to`: what was said at last.
  Finding hear_from(int from, int to, Finding finding) {
    Finding last = Finding::Silent;
    for (int now = from; now <= to; ++now) last = hear(now, finding);
    return last;
  }

  Inquiry inquiry_{Patience{.doubt_for = seconds(10), .asks = 3}, at(0)};
};

TEST_F(InquiryTest, BelievesRecordedAtTheSecondStatusThatSaysSo) {
  EXPECT_EQ(hear(1, Finding::Recorded), Finding::Silent);
  EXPECT_EQ(hear(2, Finding::Recorded), Finding::Recorded);
}

TEST_F(InquiryTest, BelievesNotRecordedOnlyOnceTheCommandPostHadTheTimeToRecordIt) {
  EXPECT_EQ(hear_from(1, 9, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(hear(10, Finding::NotRecorded), Finding::NotRecorded);
}

/// The Command Post may have made it the moment it was asked for, and recorded the report since.
TEST_F(InquiryTest, TakesAStatusThatWasLongInComingForAsOldAsItsQuestion) {
  hear_from(1, 5, Finding::NotRecorded);
  EXPECT_EQ(hear(12, Finding::NotRecorded, 512, 6), Finding::Silent);
  EXPECT_EQ(hear(13, Finding::NotRecorded, 513, 12), Finding::NotRecorded);
}

TEST_F(InquiryTest, BelievesNotRecordedOnlyAfterEnoughStatusesInARow) {
  EXPECT_EQ(hear(11, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(hear(12, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(hear(13, Finding::NotRecorded), Finding::NotRecorded);
}

TEST_F(InquiryTest, CountsAgainWhereStatusesDisagree) {
  hear_from(1, 9, Finding::NotRecorded);
  EXPECT_EQ(hear(10, Finding::Recorded), Finding::Silent);
  EXPECT_EQ(hear(11, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(hear(12, Finding::Silent), Finding::Silent);
  EXPECT_EQ(hear_from(13, 14, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(hear(15, Finding::NotRecorded), Finding::NotRecorded);
}

TEST_F(InquiryTest, TakesAContradictionAtItsWord) {
  EXPECT_EQ(hear(1, Finding::Contradicts), Finding::Contradicts);
}

TEST_F(InquiryTest, DoesNotBelieveNotRecordedWhileTheRunClockStandsStill) {
  for (int now = 1; now <= 30; ++now) EXPECT_EQ(hear(now, Finding::NotRecorded, 501), Finding::Silent);
}

TEST_F(InquiryTest, BelievesRecordedEvenWhileTheRunClockStandsStill) {
  EXPECT_EQ(hear(1, Finding::Recorded, 501), Finding::Silent);
  EXPECT_EQ(hear(9, Finding::Recorded, 501), Finding::Recorded);
}

TEST_F(InquiryTest, AsksAtOnceThenEverySecondAndAtLastEveryTen) {
  EXPECT_EQ(inquiry_.next_ask(at(0)), at(0));
  inquiry_.asked(at(2));
  EXPECT_EQ(inquiry_.next_ask(at(2)), at(3));
  inquiry_.asked(at(15));
  EXPECT_EQ(inquiry_.next_ask(at(15)), at(25));
}

TEST_F(InquiryTest, HoldsOthersBackWhileItMayStillBeDecided) {
  EXPECT_TRUE(inquiry_.is_pending(at(14.9)));
  EXPECT_FALSE(inquiry_.is_pending(at(15)));
}

TEST_F(InquiryTest, HoldsOthersBackLongerOnlyWhereTheLastStatusesSayMore) {
  hear(14, Finding::NotRecorded);
  EXPECT_TRUE(inquiry_.is_pending(at(18.9)));
  EXPECT_FALSE(inquiry_.is_pending(at(19)));
  hear(20, Finding::Silent);
  EXPECT_FALSE(inquiry_.is_pending(at(20)));
}

}  // namespace
}  // namespace adit::dispatch
