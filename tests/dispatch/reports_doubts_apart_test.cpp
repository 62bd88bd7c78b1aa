// Doubts that do not disturb each other: each one is the operator's only if the counts do not show it.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Report 1 was lost at 100 s. At 103 s a status shows a new run with 25 reports left, so that either run may
/// have recorded it, up to 110 s.
class DoubtOfEitherRun : public testing::Test {
 protected:
  DoubtOfEitherRun() {
    scene_.post(1);
    scene_.lose_answer();
    scene_.wait(3);
    receive_status(25, 0);
  }
  void receive_status(std::int64_t remaining, std::int64_t score) {
    scene_.receive_status(remaining, score, scene_.now() - 100);
  }
  void repeat(int times, std::int64_t remaining, std::int64_t score) {
    for (int i = 0; i < times; ++i) {
      scene_.wait(1);
      receive_status(remaining, score);
    }
  }
  Scene scene_;
};

TEST_F(DoubtOfEitherRun, LeavesALaterDoubtToTheCounts) {
  repeat(8, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  repeat(2, 24, 1);
  EXPECT_EQ(scene_.state(2), Settled);
  EXPECT_THAT(scene_.report(2).answer, HasSubstr(R"("score_change":1)"));
  scene_.post(3);
  scene_.lose_answer();
  repeat(12, 24, 1);
  EXPECT_EQ(scene_.send_next(), 3) << "not recorded";
  EXPECT_EQ(scene_.state(1), InDoubt);
}

TEST_F(DoubtOfEitherRun, LeavesALaterDoubtToTheCountsAfterARestart) {
  repeat(8, 25, 0);
  scene_.restart();
  repeat(2, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  EXPECT_EQ(scene_.report(2).beside, 0) << "report 1 is closed on disk";
  repeat(2, 24, 1);
  EXPECT_EQ(scene_.state(2), Settled);
}

TEST_F(DoubtOfEitherRun, ExplainsOneReportUntilItIsClosed) {
  repeat(2, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  EXPECT_EQ(scene_.report(2).beside, 1);
  repeat(40, 24, 0);
  EXPECT_EQ(scene_.state(2), InDoubt) << "either may be recorded";
  EXPECT_FALSE(scene_.reports().is_asking(scene_.report(2)));
  EXPECT_THAT(scene_.report(2).note, HasSubstr("1 other report in doubt may explain it"));
  scene_.post(3);
  scene_.lose_answer();
  EXPECT_EQ(scene_.report(3).beside, 0);
  repeat(2, 23, 0);
  EXPECT_EQ(scene_.state(3), Settled) << "both earlier ones are closed";
  EXPECT_EQ(scene_.state(2), InDoubt);
}

TEST_F(DoubtOfEitherRun, ExplainsNothingIfNothingIsCounted) {
  repeat(2, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  repeat(12, 25, 0);
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(DoubtOfEitherRun, ExplainsOneOfTwo) {
  repeat(2, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  repeat(2, 23, 1);
  EXPECT_EQ(scene_.state(2), Settled);
  EXPECT_THAT(scene_.report(2).answer, HasSubstr(R"("score_change":null)")) << "either may have the point";
}

TEST_F(DoubtOfEitherRun, ContradictsNoMoreThanItExplains) {
  repeat(2, 25, 0);
  repeat(2, 24, 1);
  EXPECT_THAT(scene_.reports().run().unreliable, IsEmpty()) << "it was recorded late";
  repeat(10, 24, 1);
  repeat(2, 23, 1);
  EXPECT_THAT(scene_.reports().run().unreliable, HasSubstr("another sender")) << "it is closed";
}

TEST_F(DoubtOfEitherRun, IsClosedOnlyByAStatusThatWasAskedLateEnough) {
  scene_.wait(8);
  scene_.reports().on_status({0, 11, 25, "adit"}, scene_.time().now - std::chrono::seconds(2), scene_.time());
  EXPECT_FALSE(scene_.report(1).counted);
  repeat(1, 25, 0);
  EXPECT_TRUE(scene_.report(1).counted);
  EXPECT_TRUE(scene_.output().ledger.at(1).counted) << "on disk";
}

TEST_F(DoubtOfEitherRun, IsNotClosedWhileTheClockStands) {
  repeat(2, 25, 0);
  for (int i = 0; i < 20; ++i) {
    scene_.wait(1);
    scene_.receive_status(25, 0, 5);
  }
  EXPECT_FALSE(scene_.report(1).counted) << "an administrative stop hides a record";
}

TEST_F(DoubtOfEitherRun, StaysOpenIfItCannotBeWritten) {
  scene_.output().full = true;
  repeat(8, 25, 0);
  EXPECT_FALSE(scene_.report(1).counted);
  scene_.output().full = false;
  repeat(1, 25, 0);
  EXPECT_TRUE(scene_.report(1).counted);
}

TEST_F(DoubtOfEitherRun, HasItsOwnReason) {
  repeat(8, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  repeat(1, 24, 0);
  repeat(1, 25, 0);  // one is granted: the count rises
  EXPECT_THAT(scene_.report(1).note, HasSubstr("a new run began just after it was sent"));
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the reports left went up from 24 to 25"));
  EXPECT_THAT(scene_.report(2).note, Not(HasSubstr("a new run")));
}

TEST_F(DoubtOfEitherRun, EndsTheProofOfTheRunIfAnotherSenderReports) {
  repeat(8, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  repeat(1, 22, 0);
  EXPECT_THAT(scene_.reports().run().unreliable, HasSubstr("another sender may report"));
  scene_.post(3);
  scene_.lose_answer();
  repeat(30, 22, 0);
  EXPECT_EQ(scene_.state(2), InDoubt);
  EXPECT_EQ(scene_.state(3), InDoubt);
}

TEST_F(DoubtOfEitherRun, BlursNoOtherIfTheOperatorDecidesItLate) {
  repeat(8, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  ASSERT_TRUE(scene_.reports().settle(1, scene_.time()));
  repeat(2, 24, 0);
  EXPECT_EQ(scene_.state(2), Settled);
}

TEST_F(DoubtOfEitherRun, BlursOthersIfTheOperatorDecidesItEarly) {
  repeat(2, 25, 0);
  scene_.post(2);
  scene_.lose_answer();
  ASSERT_TRUE(scene_.reports().settle(1, scene_.time()));
  repeat(30, 24, 0);
  EXPECT_EQ(scene_.state(2), InDoubt);
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the operator decided about report 1"));
}

/// Two reports of which one was recorded: the counts never show which.
TEST(AmbiguousDoubts, LeaveALaterDoubtToTheCounts) {
  Scene scene;
  scene.post(1);
  scene.lose_answer();
  scene.repeat_stop(16);
  scene.post(2);
  scene.lose_answer();
  for (int i = 0; i < 40; ++i) {
    scene.wait(1);
    scene.receive_status(19, 0);
  }
  ASSERT_EQ(scene.state(1), InDoubt);
  ASSERT_EQ(scene.state(2), InDoubt);
  scene.post(3);
  scene.lose_answer();
  for (int i = 0; i < 2; ++i) {
    scene.wait(1);
    scene.receive_status(18, 1);
  }
  EXPECT_EQ(scene.state(3), Settled);
  EXPECT_THAT(scene.report(3).answer, HasSubstr(R"("score_change":1)"));
  EXPECT_EQ(scene.state(1), InDoubt);
}

/// Report 1 stays in doubt, because no report is left. More are granted, and report 2 is sent.
TEST(DoubtWithoutReportsLeft, LeavesALaterDoubtToTheCounts) {
  Scene scene;
  scene.restart();
  scene.receive_status(0, 0);
  scene.post(1);
  scene.lose_answer();
  for (int i = 0; i < 20; ++i) {
    scene.wait(1);
    scene.receive_status(0, 0);
  }
  scene.wait(1);
  scene.receive_status(5, 0);
  EXPECT_EQ(scene.state(1), InDoubt);
  scene.post(2);
  scene.lose_answer();
  for (int i = 0; i < 2; ++i) {
    scene.wait(1);
    scene.receive_status(4, 0);
  }
  EXPECT_EQ(scene.state(2), Settled);
  EXPECT_EQ(scene.state(1), InDoubt);
}

/// Reports 2 and 3 are found recorded with one point, so that it may be of either.
TEST(DoubtBeforeTwoThatWereFound, IsNotContradictedByTheirPoint) {
  Scene scene;
  const auto fail = [&scene](int times) {
    for (int i = 0; i < times; ++i) {
      scene.wait(1);
      scene.reports().on_status_failed(NoStatus::Other, scene.time());
    }
  };
  scene.post(1);
  scene.lose_answer();
  fail(20);
  scene.receive_status(20, 0);
  fail(6);
  ASSERT_EQ(scene.count(), 1U);
  scene.post_queued(2);
  ASSERT_EQ(scene.send_next(), 2);
  scene.lose_answer();
  fail(20);
  scene.post_queued(3);
  ASSERT_EQ(scene.send_next(), 3);
  scene.lose_answer();
  scene.repeat_status(2, 18, 1);
  ASSERT_EQ(scene.state(2), Settled);
  ASSERT_EQ(scene.state(3), Settled);
  scene.repeat_status(12, 18, 1);
  EXPECT_THAT(scene.reports().run().unreliable, IsEmpty());
  EXPECT_EQ(scene.send_next(), 1) << "not recorded";
}

}  // namespace
}  // namespace adit::dispatch
