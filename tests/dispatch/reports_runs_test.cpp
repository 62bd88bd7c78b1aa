// A new run and the reports of the last one.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(NewRun, ShowsByMoreReportsLeft) {
  Scene scene;
  scene.wait(10);
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.reports().run().number, 2);
  EXPECT_THAT(scene.output().run->why, HasSubstr("the reports left went up from 20 to 25"));
  EXPECT_EQ(scene.output().run->last->remaining_reports, 25);
}

TEST(NewRun, ShowsByTheRunOfAnAnswer) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer(0, "scored", "1", 101));
  scene.post(2);
  scene.wait(12);
  scene.answer(recorded_answer(0, "scored", "2", 113));
  EXPECT_EQ(scene.reports().run().number, 2);
  EXPECT_EQ(scene.reports().run().id, "2");
  EXPECT_EQ(scene.report(1).run, 1);
  EXPECT_EQ(scene.report(2).run, 2);
}

TEST(NewRun, HoldsQueuedReportsOfTheLastRun) {
  Scene scene;
  scene.post_queued(1);
  scene.wait(11);
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_THAT(scene.report(1).note, HasSubstr("a new run began (the run clock went back"));
  EXPECT_EQ(scene.output().ledger.at(1).state, Held) << "stored with the run";
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 1);
  EXPECT_EQ(scene.report(1).run, 2);
}

TEST(NewRun, TakesInReportsPostedJustBefore) {
  Scene scene;
  scene.post_queued(1);
  scene.wait(9);
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 2);
  EXPECT_EQ(scene.output().ledger.at(1).run, 2);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(NewRun, TakesInAReportRepeatedJustBefore) {
  Scene scene;
  scene.post_queued(1);
  scene.wait(60);
  scene.post(1);
  scene.wait(5);
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 2);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(NewRun, HoldsReportsThatTheOperatorSentBefore) {
  Scene scene;
  scene.post_queued(1);
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  scene.wait(11);
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.state(1), Held);
}

TEST(DoubtAtANewRun, BelongsToTheNewRun) {
  Scene scene;
  scene.post(1);
  scene.lose_answer();
  scene.wait(5);
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 2);
  EXPECT_EQ(scene.report(1).before, std::nullopt) << "counted in the run before";
  EXPECT_FALSE(scene.reports().is_asking(scene.report(1)));
  EXPECT_THAT(scene.report(1).note, HasSubstr("the operator decides"));
  const ClientId again = scene.post(1);
  EXPECT_EQ(scene.count(), 1);
  scene.repeat_status(20, 25, 0);
  EXPECT_EQ(scene.state(1), InDoubt);
  EXPECT_EQ(scene.answer_to(again).status, 504);
}

TEST(DoubtAtANewRun, StaysInItsRunIfOlderThanItsLastStatus) {
  Scene scene;
  scene.post(1);
  scene.lose_answer();
  for (int i = 0; i < 30; ++i) {
    scene.wait(1);
    scene.receive_status(20, 0, 101);  // an administrative stop keeps it in doubt
  }
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 1);
  EXPECT_THAT(scene.report(1).note, HasSubstr("a new run began before the counts could tell"));
  scene.post(1);
  EXPECT_EQ(scene.state(2), Held) << "the run of report 1 may go on";
  scene.record(2, "1");
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_EQ(scene.state(2), Held) << "no name is known of the first run";
}

TEST(DeclaredRun, BeginsLikeADetectedOne) {
  Scene scene;
  scene.post_queued(1);
  scene.wait(11);
  EXPECT_EQ(scene.reports().declare_new_run(scene.time()), 2);
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_EQ(scene.output().run->why, "the operator declared it");
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.reports().run().number, 2) << "no further run";
}

/// The operator declares a run while a report is in flight. Either run may record it.
class ReportInFlightAtADeclaration : public testing::Test {
 protected:
  ReportInFlightAtADeclaration() {
    scene_.post(1);
    scene_.wait(12);
    scene_.reports().declare_new_run(scene_.time());
  }
  Scene scene_;
};

TEST_F(ReportInFlightAtADeclaration, IsJoinedByARepeat) {
  const ClientId again = scene_.post(1);
  EXPECT_EQ(scene_.count(), 1);
  scene_.answer(recorded_answer());
  EXPECT_EQ(scene_.answer_to(again).status, 201);
  EXPECT_EQ(scene_.report(1).run, 2);
}

TEST_F(ReportInFlightAtADeclaration, IsInDoubtInTheNewRunIfItsAnswerIsLost) {
  scene_.lose_answer();
  EXPECT_EQ(scene_.report(1).run, 2);
  EXPECT_EQ(scene_.report(1).before, std::nullopt);
  scene_.receive_status(25, 0, 3);
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 1);
}

TEST_F(ReportInFlightAtADeclaration, IsHeldAfterA429) {
  scene_.answer(answer_of(429));
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(1), Held);
}

TEST_F(ReportInFlightAtADeclaration, IsRetriedAfterA429IfAClientRepeatedIt) {
  scene_.post(1);
  scene_.answer(answer_of(429));
  EXPECT_EQ(scene_.send_next(), 1);
  EXPECT_EQ(scene_.report(1).run, 2);
}

TEST_F(ReportInFlightAtADeclaration, IsInDoubtInTheNewRunAfterARestart) {
  scene_.restart();
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_EQ(scene_.report(1).run, 2);
  EXPECT_EQ(scene_.report(1).before, std::nullopt);
}

TEST(SilentCommandPost, GetsOnlyNewReportsIfItHasNoStatus) {
  Scene scene;
  scene.wait(16);
  scene.post(1);
  EXPECT_EQ(scene.send_next(), 0);
  scene.reports().on_status_failed(NoStatus::Other, scene.time());
  EXPECT_EQ(scene.send_next(), 1);
  scene.answer(answer_of(429));
  scene.wait(11);
  scene.reports().on_status_failed(NoStatus::Other, scene.time());
  EXPECT_EQ(scene.send_next(), 0) << "its run may be over";
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(SilentCommandPost, GetsNoReportIfItCannotBeReached) {
  Scene scene;
  scene.wait(16);
  scene.post(1);
  scene.reports().on_status_failed(NoStatus::NoAnswer, scene.time());
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_THAT(scene.undecided(), IsEmpty());
}

}  // namespace
}  // namespace adit::dispatch
