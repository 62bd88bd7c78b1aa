// Reports whose answer was lost.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A report was lost at 100 s. 20 reports were left, and the score was 0.
class Doubt : public testing::Test {
 protected:
  Doubt() : client_(scene_.post(1)) { scene_.lose_answer(); }
  void repeat_status_after_stop(int times, std::int64_t remaining, std::int64_t score) {
    for (int i = 0; i < times; ++i) {
      scene_.wait(1);
      scene_.receive_status(remaining, score, clock_++);
    }
  }

  Scene scene_;
  ClientId client_;
  double clock_ = 118;
};

TEST_F(Doubt, IsSettledByTwoStatusesThatCountTheReport) {
  scene_.receive_status(19, 1);
  EXPECT_EQ(scene_.state(1), InDoubt);
  scene_.wait(1);
  scene_.receive_status(19, 1);
  EXPECT_EQ(scene_.state(1), Settled);
  const auto told = scene_.answer_to(client_);
  EXPECT_EQ(told.status, 201);
  EXPECT_THAT(told.body, HasSubstr(R"("score_change":1)"));
  EXPECT_THAT(told.body, HasSubstr(R"("reconciled":true)"));
  EXPECT_EQ(scene_.report(1).note,
            "found recorded: reports left went from 20 to 19, the score went from 0 to 1");
}

TEST_F(Doubt, GivesARepeatTheReconciledAnswer) {
  scene_.repeat_status(2, 19, 0);
  EXPECT_EQ(scene_.answer_to(scene_.post(1)).body, scene_.answer_to(client_).body);
  EXPECT_EQ(scene_.count(), 1);
}

TEST_F(Doubt, EndsWithARetryIfTheReportIsNotCounted) {
  scene_.repeat_status(9, 20, 0);
  EXPECT_EQ(scene_.state(1), InDoubt) << "it may still be recorded";
  scene_.repeat_status(1, 20, 0);
  EXPECT_EQ(scene_.state(1), Queued);
  EXPECT_FALSE(scene_.is_answered(client_));
  EXPECT_EQ(scene_.send_next(), 1);
  EXPECT_EQ(scene_.report(1).before->remaining_reports, 20);
  scene_.answer(recorded_answer());
  EXPECT_EQ(scene_.answer_to(client_).body, recorded_answer().body);
}

TEST_F(Doubt, IsLeftToTheOperatorIfTheCountContradicts) {
  scene_.wait(1);
  scene_.receive_status(18, 0);
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_FALSE(scene_.reports().is_asking(scene_.report(1)));
  EXPECT_THAT(scene_.report(1).note, StartsWith("another sender may report with this token: "));
  EXPECT_THAT(scene_.report(1).note, EndsWith("; the operator decides: Send again or Settle"));
  EXPECT_NE(scene_.reports().run().unreliable, "");
  scene_.repeat_status(60, 19, 0);
  EXPECT_EQ(scene_.state(1), InDoubt) << "a later count decides nothing";
  scene_.post(2);
  EXPECT_EQ(scene_.state(2), Sending);
  EXPECT_EQ(scene_.report(2).before, std::nullopt);
}

TEST_F(Doubt, BlocksOtherReportsWhileItIsPending) {
  scene_.post(2);
  scene_.repeat_stop(14);
  EXPECT_EQ(scene_.send_next(), 0);
  scene_.repeat_stop(1);
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(Doubt, AsksForTheStatusEverySecond) {
  EXPECT_LE(*scene_.reports().next_requests(scene_.time()).status, scene_.time().now);
  scene_.wait(0.5);
  scene_.reports().on_status_failed(NoStatus::NoAnswer, scene_.time());
  const auto next = *scene_.reports().next_requests(scene_.time()).status;
  EXPECT_EQ(next, scene_.time().now + std::chrono::seconds(1));
}

TEST_F(Doubt, StaysWhileNoStatusComes) {
  for (int i = 0; i < 100; ++i) {
    scene_.wait(1);
    scene_.reports().on_status_failed(i % 2 == 0 ? NoStatus::Other : NoStatus::NoAnswer, scene_.time());
  }
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_THAT(scene_.report(1).note,
              HasSubstr("the Command Post does not answer with the run's status; the operator decides"));
  scene_.receive_status(20, 0);
  scene_.wait(1);
  scene_.receive_status(20, 0);
  EXPECT_EQ(scene_.state(1), InDoubt) << "after two of three statuses";
  scene_.wait(1);
  scene_.receive_status(20, 0);
  EXPECT_EQ(scene_.state(1), Queued);
}

TEST_F(Doubt, StaysWhileTheRunClockStands) {
  scene_.repeat_stop(60);
  EXPECT_EQ(scene_.state(1), InDoubt) << "an administrative stop hides a record";
  EXPECT_FALSE(scene_.reports().is_asking(scene_.report(1))) << "the operator may decide";
  EXPECT_THAT(scene_.report(1).note, HasSubstr("the operator decides"));
}

TEST_F(Doubt, AccountsForReportsAnsweredSince) {
  scene_.repeat_stop(16);
  scene_.post(2);
  ASSERT_EQ(scene_.state(2), Sending);
  scene_.answer(recorded_answer(1, "scored", "1", 117));
  repeat_status_after_stop(2, 18, 1);
  EXPECT_EQ(scene_.state(1), Settled);
  EXPECT_THAT(scene_.report(1).answer, HasSubstr(R"("score_change":0)")) << "the point is report 2's";
}

/// Report 2 was lost while report 1 was in doubt.
class TwoDoubts : public Doubt {
 protected:
  TwoDoubts() {
    scene_.repeat_stop(16);
    other_ = scene_.post(2);
    scene_.lose_answer();
  }
  ClientId other_ = 0;
};

TEST_F(TwoDoubts, AreSettledIfBothAreCounted) {
  EXPECT_EQ(scene_.report(2).before, std::nullopt) << "the count is uncertain";
  repeat_status_after_stop(2, 18, 1);
  for (const ClientId client : {client_, other_}) {
    EXPECT_EQ(scene_.answer_to(client).status, 201);
    EXPECT_THAT(scene_.answer_to(client).body, HasSubstr(R"("score_change":null)"))
        << "either may have the point";
  }
  EXPECT_EQ(scene_.state(1), Settled);
}

TEST_F(TwoDoubts, AreResentInOrderIfNoneIsCounted) {
  repeat_status_after_stop(14, 20, 0);
  EXPECT_EQ(scene_.send_next(), 1);
  scene_.answer(recorded_answer());
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(TwoDoubts, StayIfOneIsCounted) {
  repeat_status_after_stop(60, 19, 0);
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_EQ(scene_.state(2), InDoubt);
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the counts do not show which of them was recorded"));
}

TEST_F(TwoDoubts, AreDecidedInOneWriteOrNone) {
  repeat_status_after_stop(1, 18, 0);
  scene_.output().full = true;
  repeat_status_after_stop(1, 18, 0);
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_EQ(scene_.state(2), InDoubt);
  scene_.output().full = false;
  scene_.output().writes_until_full = 1;
  repeat_status_after_stop(1, 18, 0);
  EXPECT_EQ(scene_.state(1), Settled);
  EXPECT_EQ(scene_.state(2), Settled);
}

TEST(DoubtsCount, IncludesReportsSentBefore) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer(1));
  scene.post(2);
  scene.lose_answer();
  scene.repeat_status(2, 18, 1);
  EXPECT_EQ(scene.state(2), Settled);
  EXPECT_THAT(scene.report(2).answer, HasSubstr(R"("score_change":0)"));
}

TEST(DoubtsCount, IsLeftToTheOperatorIfUnknownBefore) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer(0, "admin stop"));
  const ClientId client = scene.post(2);
  scene.lose_answer();
  EXPECT_FALSE(scene.reports().is_asking(scene.report(2)));
  scene.repeat_status(20, 20, 0);
  EXPECT_EQ(scene.state(2), InDoubt);
  EXPECT_THAT(scene.report(2).note, HasSubstr("are not certain; the operator decides"));
  EXPECT_EQ(scene.answer_to(client).status, 504);
}

TEST(DoubtsCount, IsLeftToTheOperatorIfNoReportIsLeft) {
  Scene exhausted;
  exhausted.restart();
  exhausted.receive_status(0, 0);
  exhausted.post(1);
  exhausted.lose_answer();
  exhausted.repeat_status(60, 0, 0);
  EXPECT_EQ(exhausted.state(1), InDoubt);
  EXPECT_THAT(exhausted.report(1).note, HasSubstr("the counts cannot show a report now"));
  EXPECT_THAT(exhausted.reports().run().unreliable, IsEmpty());
}

}  // namespace
}  // namespace adit::dispatch
