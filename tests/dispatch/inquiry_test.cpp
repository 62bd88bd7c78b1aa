#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dispatch/run_account.hpp"

namespace adit::dispatch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Instant at(double s) {
  return Instant{} + milliseconds(static_cast<std::int64_t>(s * 1000));
}

/// An answer was lost at 0 s, when the run clock showed 500 s.
class InquiryTest : public testing::Test {
 protected:
  Finding add_evidence(double now, Finding finding) { return add_evidence(now, finding, 500 + now); }
  Finding add_evidence(double now, Finding finding, double run_clock) {
    return add_evidence(now, finding, run_clock, now);
  }
  Finding add_evidence(double now, Finding finding, double run_clock, double asked) {
    return inquiry_.add_evidence({.finding = finding, .why = "", .points_each = std::nullopt}, run_clock,
                                 at(asked), at(now));
  }
  /// One status each second. Returns the last finding.
  Finding hear_from(int from, int to, Finding finding) {
    Finding last = Finding::Silent;
    for (int now = from; now <= to; ++now) last = add_evidence(now, finding);
    return last;
  }

  Inquiry inquiry_{InquiryPolicy{.doubt_for = seconds(10), .asks = 3}, at(0)};
};

TEST_F(InquiryTest, BelievesRecordedAtTheSecondStatus) {
  EXPECT_EQ(add_evidence(1, Finding::Recorded), Finding::Silent);
  EXPECT_EQ(add_evidence(2, Finding::Recorded), Finding::Recorded);
}

TEST_F(InquiryTest, BelievesNotRecordedAfterTenSeconds) {
  EXPECT_EQ(hear_from(1, 9, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(add_evidence(10, Finding::NotRecorded), Finding::NotRecorded);
}

/// The status may be as old as its request, and the report recorded since.
TEST_F(InquiryTest, DatesAStatusByItsRequest) {
  hear_from(1, 5, Finding::NotRecorded);
  EXPECT_EQ(add_evidence(12, Finding::NotRecorded, 512, 6), Finding::Silent);
  EXPECT_EQ(add_evidence(13, Finding::NotRecorded, 513, 12), Finding::NotRecorded);
}

TEST_F(InquiryTest, BelievesNotRecordedAfterThreeStatusesInARow) {
  EXPECT_EQ(add_evidence(11, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(add_evidence(12, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(add_evidence(13, Finding::NotRecorded), Finding::NotRecorded);
}

TEST_F(InquiryTest, StartsAgainIfStatusesDisagree) {
  hear_from(1, 9, Finding::NotRecorded);
  EXPECT_EQ(add_evidence(10, Finding::Recorded), Finding::Silent);
  EXPECT_EQ(add_evidence(11, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(add_evidence(12, Finding::Silent), Finding::Silent);
  EXPECT_EQ(hear_from(13, 14, Finding::NotRecorded), Finding::Silent);
  EXPECT_EQ(add_evidence(15, Finding::NotRecorded), Finding::NotRecorded);
}

TEST_F(InquiryTest, BelievesAContradictionAtOnce) {
  EXPECT_EQ(add_evidence(1, Finding::Contradicts), Finding::Contradicts);
}

TEST_F(InquiryTest, DoubtsNotRecordedWhileTheRunClockStands) {
  for (int now = 1; now <= 30; ++now)
    EXPECT_EQ(add_evidence(now, Finding::NotRecorded, 501), Finding::Silent);
}

TEST_F(InquiryTest, BelievesRecordedWhileTheRunClockStands) {
  EXPECT_EQ(add_evidence(1, Finding::Recorded, 501), Finding::Silent);
  EXPECT_EQ(add_evidence(9, Finding::Recorded, 501), Finding::Recorded);
}

TEST_F(InquiryTest, AsksEverySecond) {
  EXPECT_EQ(inquiry_.next_ask(at(0)), at(0));
  inquiry_.on_asked(at(2));
  EXPECT_EQ(inquiry_.next_ask(at(2)), at(3));
}

TEST_F(InquiryTest, AsksOnceMoreWhenItsTimeIsOverSoThatTheOperatorMayDecideThen) {
  inquiry_.on_asked(at(14.5));
  inquiry_.on_failed(at(14.5));
  EXPECT_EQ(inquiry_.next_ask(at(15.1)), at(15.5));
  inquiry_.on_asked(at(15.5));
  inquiry_.on_failed(at(15.5));
  EXPECT_TRUE(inquiry_.has_timed_out());
  EXPECT_EQ(inquiry_.next_ask(at(16)), at(25.5));
}

TEST_F(InquiryTest, BlocksOtherReportsWhileItIsPending) {
  EXPECT_TRUE(inquiry_.is_pending(at(14.9)));
  EXPECT_FALSE(inquiry_.is_pending(at(15)));
}

TEST_F(InquiryTest, BlocksLongerIfTheLastStatusHelps) {
  add_evidence(14, Finding::NotRecorded);
  EXPECT_TRUE(inquiry_.is_pending(at(18.9)));
  EXPECT_FALSE(inquiry_.is_pending(at(19)));
  add_evidence(20, Finding::Silent);
  EXPECT_FALSE(inquiry_.is_pending(at(20)));
}

constexpr std::optional<std::int64_t> kUnknown = std::nullopt;

icd::RunStatus status(std::int64_t remaining, std::int64_t score, double clock = 300) {
  return {score, clock, remaining, "adit"};
}

struct EvidenceCase {
  const char* name;
  icd::RunStatus before;
  std::int64_t doubts;
  std::int64_t beside;
  LaterReports since;
  icd::RunStatus now;
  Finding finding;
  std::optional<std::int64_t> points_each;
};
void PrintTo(const EvidenceCase& one, std::ostream* out) {
  *out << one.name;
}

const EvidenceCase kEvidenceCases[] = {
    {"NothingChanged", status(20, 3), 1, 0, {}, status(20, 3), Finding::NotRecorded, kUnknown},
    {"OneUsedAndNoPoint", status(20, 3), 1, 0, {}, status(19, 3), Finding::Recorded, 0},
    {"OneUsedAndAPoint", status(20, 3), 1, 0, {}, status(19, 4), Finding::Recorded, 1},
    {"TheLastOneUsed", status(1, 3), 1, 0, {}, status(0, 3), Finding::Recorded, 0},
    {"TwoUsedByOne", status(20, 3), 1, 0, {}, status(18, 3), Finding::Contradicts, kUnknown},
    {"MoreLeftThanBefore", status(20, 3), 1, 0, {}, status(21, 3), Finding::Contradicts, kUnknown},
    {"APointForNothing", status(20, 3), 1, 0, {}, status(20, 4), Finding::Contradicts, kUnknown},
    {"TwoPointsForOne", status(20, 3), 1, 0, {}, status(19, 5), Finding::Contradicts, kUnknown},
    {"APointLost", status(20, 3), 1, 0, {}, status(19, 2), Finding::Contradicts, kUnknown},
    {"NothingLeftToUse", status(0, 3), 1, 0, {}, status(0, 3), Finding::Silent, kUnknown},
    {"ClockNotStarted", status(20, 0, 0), 1, 0, {}, status(20, 0, 0), Finding::Silent, kUnknown},
    {"StartedSince", status(20, 0, 0), 1, 0, {}, status(20, 0, 9), Finding::NotRecorded, kUnknown},
    {"StartedSinceWithOtherCounts", status(5, 0, 0), 1, 0, {}, status(25, 0, 9), Finding::Silent, kUnknown},
    {"StartedSinceWithOneLess", status(20, 0, 0), 1, 0, {}, status(19, 0, 9), Finding::Silent, kUnknown},
    {"TwoOfTwo", status(20, 3), 2, 0, {}, status(18, 3), Finding::Recorded, 0},
    {"TwoOfTwoWithBothPoints", status(20, 3), 2, 0, {}, status(18, 5), Finding::Recorded, 1},
    {"TwoOfTwoWithOnePoint", status(20, 3), 2, 0, {}, status(18, 4), Finding::Recorded, kUnknown},
    {"OneOfTwo", status(20, 3), 2, 0, {}, status(19, 3), Finding::Silent, kUnknown},
    {"NoneOfTwo", status(20, 3), 2, 0, {}, status(20, 3), Finding::NotRecorded, kUnknown},
    {"ThreeOfTwo", status(20, 3), 2, 0, {}, status(17, 3), Finding::Contradicts, kUnknown},
    {"NoneOfOneAndOneBeside", status(20, 3), 1, 1, {}, status(20, 3), Finding::NotRecorded, kUnknown},
    {"OneOfOneAndOneBeside", status(20, 3), 1, 1, {}, status(19, 4), Finding::Silent, kUnknown},
    {"TwoOfOneAndOneBeside", status(20, 3), 1, 1, {}, status(18, 3), Finding::Recorded, 0},
    {"TwoOfOneAndOneBesideWithOnePoint", status(20, 3), 1, 1, {}, status(18, 4), Finding::Recorded, kUnknown},
    {"ThreeOfOneAndOneBeside", status(20, 3), 1, 1, {}, status(17, 3), Finding::Contradicts, kUnknown},
    {"OnlyWhatWasSentSince", status(20, 3), 1, 0, {2, 1}, status(18, 4), Finding::NotRecorded, kUnknown},
    {"OneMoreThanSentSince", status(20, 3), 1, 0, {2, 1}, status(17, 5), Finding::Recorded, 1},
    {"LessThanSentSince", status(20, 3), 1, 0, {2, 0}, status(19, 3), Finding::Contradicts, kUnknown},
    {"APointOfSentSince", status(20, 3), 1, 0, {2, 0, 2}, status(18, 4), Finding::NotRecorded, kUnknown},
    {"TooManyPointsOfSentSince",
     status(20, 3),
     1,
     0,
     {2, 0, 2},
     status(18, 6),
     Finding::Contradicts,
     kUnknown},
    {"OneMoreWithAPointOfEither", status(20, 3), 1, 0, {2, 0, 2}, status(17, 4), Finding::Recorded, kUnknown},
    {"OneMoreWithAllPoints", status(20, 3), 1, 0, {2, 0, 2}, status(17, 6), Finding::Recorded, 1},
    {"OneMoreWithoutPoints", status(20, 3), 1, 0, {2, 0, 2}, status(17, 3), Finding::Recorded, 0},
    {"UsedUpBySentSince", status(2, 3), 1, 0, {2, 0}, status(0, 3), Finding::Silent, kUnknown},
};

class EvidenceTable : public testing::TestWithParam<EvidenceCase> {};

TEST_P(EvidenceTable, FollowsFromTheCounts) {
  const EvidenceCase& one = GetParam();
  const Evidence evidence = weigh(one.before, one.doubts, one.beside, one.since, one.now);
  EXPECT_EQ(evidence.finding, one.finding) << evidence.why;
  EXPECT_EQ(evidence.points_each, one.points_each);
}

INSTANTIATE_TEST_SUITE_P(Counts, EvidenceTable, testing::ValuesIn(kEvidenceCases),
                         [](const auto& one) { return one.param.name; });

TEST(Evidence, ExplainsItselfWithFigures) {
  EXPECT_EQ(weigh(status(20, 3), 2, 0, {1, 1}, status(19, 4)).why,
            "reports left went from 20 to 19, the score went from 3 to 4, 1 of it by reports sent since, "
            "with 2 reports in doubt");
  EXPECT_EQ(weigh(status(20, 3), 1, 0, {}, status(20, 3)).why, "reports left stayed 20, the score stayed 3");
  EXPECT_THAT(weigh(status(20, 3), 1, 0, {}, status(18, 3)).why,
              testing::HasSubstr("another sender may report"));
}

TEST(Evidence, NamesOtherDoubtsThatMayExplainIt) {
  EXPECT_THAT(weigh(status(20, 3), 1, 1, {}, status(19, 3)).why,
              testing::HasSubstr("1 other report in doubt may explain it"));
  EXPECT_THAT(weigh(status(20, 3), 1, 1, {}, status(20, 3)).why,
              testing::Not(testing::HasSubstr("may explain")));
}

/// The law behind the table: without another sender there is no contradiction, and no finding is wrong.
/// `done` of the doubts and `late` of those beside them were recorded.
TEST(Evidence, IsTrueWithoutAnotherSender) {
  struct Case {
    std::int64_t left, doubts, beside, done, late, others;
  };
  std::vector<Case> cases;
  for (std::int64_t left = 1; left <= 6; ++left)
    for (std::int64_t doubts = 1; doubts <= 3; ++doubts)
      for (std::int64_t beside = 0; beside <= 2; ++beside)
        for (std::int64_t done = 0; done <= doubts; ++done)
          for (std::int64_t late = 0; late <= beside; ++late)
            for (std::int64_t others = 0; others + done + late <= left; ++others)
              cases.push_back({left, doubts, beside, done, late, others});
  for (const auto& [left, doubts, beside, done, late, others] : cases) {
    for (std::int64_t points = 0; points <= done + late; ++points) {
      const auto now = status(left - done - late - others, 3 + points);
      const Finding finding = weigh(status(left, 3), doubts, beside, {others, 0}, now).finding;
      EXPECT_NE(finding, Finding::Contradicts);
      EXPECT_TRUE(finding != Finding::Recorded || done == doubts);
      EXPECT_TRUE(finding != Finding::NotRecorded || done == 0);
    }
  }
}

}  // namespace
}  // namespace adit::dispatch
