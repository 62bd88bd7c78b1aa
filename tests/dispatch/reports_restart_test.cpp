// What a restart makes of the ledger.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;

TEST(Restart, PutsAReportInFlightInDoubt) {
  Scene scene;
  scene.post();
  scene.restart();
  EXPECT_EQ(scene.state(1), InDoubt);
  EXPECT_EQ(scene.report(1).tries, 1);
  EXPECT_EQ(scene.report(1).note, "the box stopped while it was in flight");
  EXPECT_TRUE(scene.reports().is_asking(scene.report(1)));
  scene.repeat_status(2, 19, 1);
  EXPECT_EQ(scene.state(1), Settled);
  EXPECT_THAT(scene.report(1).answer, HasSubstr(R"("score_change":1)"));
}

TEST(Restart, KeepsTheCountOfReportsSentSinceADoubt) {
  Scene scene;
  scene.post(1);
  scene.lose_answer();
  scene.repeat_stop(16);
  scene.post(2);
  scene.answer(recorded_answer(1, "scored", "1", 117));
  scene.restart();
  scene.repeat_status(12, 19, 1);
  EXPECT_EQ(scene.send_next(), 1) << "the count is report 2's";
}

TEST(Restart, GivesADoubtItsWholeTimeAgain) {
  Scene scene;
  scene.post();
  scene.lose_answer();
  scene.repeat_status(9, 20, 0);
  scene.restart();
  scene.repeat_status(9, 20, 0);
  EXPECT_EQ(scene.state(1), InDoubt) << "its bytes may have left before the stop";
  scene.repeat_status(1, 20, 0);
  EXPECT_EQ(scene.state(1), Queued);
}

TEST(Restart, SendsQueuedReportsOnceTheRunIsKnown) {
  Scene scene;
  scene.post_queued();
  scene.restart();
  EXPECT_EQ(scene.send_next(), 0);
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(Restart, HoldsQueuedReportsIfTheRunIsAnother) {
  Scene scene;
  scene.post_queued();
  scene.restart();
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.state(1), Held);
}

/// The run clock has advanced, so it can show a new run.
struct RunningClock : testing::Test {
  RunningClock() {
    scene.wait(5);
    scene.receive_status(20, 0);
    scene.post_queued();
  }
  Scene scene;
};

TEST_F(RunningClock, ShowsNoNewRunAfterAClockStep) {
  scene.step_clock(5e6);
  scene.restart();
  scene.receive_status(20, 0, 110);
  EXPECT_EQ(scene.reports().run().number, 1);
  EXPECT_EQ(scene.state(1), Queued) << "the same run";
}

TEST_F(RunningClock, ShowsANewRunAfterAClockStepAndASilence) {
  scene.step_clock(5e6);
  scene.wait(3600);
  scene.restart();
  scene.receive_status(20, 0, 120);
  EXPECT_EQ(scene.state(1), Held);
}

TEST(Restart, KeepsEachOtherState) {
  for (const ReportState state : {Held, Queued, Answered, Rejected, InDoubt, Settled, Withdrawn}) {
    Scene scene;
    Report report;
    report.number = 1;
    report.run = 1;
    report.state = state;
    report.note = "as it was";
    scene.output().ledger[1] = report;
    scene.restart();
    EXPECT_EQ(scene.report(1), report) << name_of(state);
  }
}

TEST(Restart, ContinuesTheOrderOfSending) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer());
  scene.restart();
  scene.receive_status(19, 0);
  scene.post(2);
  EXPECT_EQ(scene.report(2).sending, 2);
}

TEST(Restart, KeepsDistrustInTheCount) {
  Scene scene;
  scene.receive_status(18, 0);
  scene.receive_status(18, 0);
  scene.restart();
  scene.receive_status(18, 0);
  scene.post();
  EXPECT_EQ(scene.report(1).before, std::nullopt);
}

TEST(Restart, ComparesEachQueuedReportWithEarlierOnes) {
  ReportRules rules;
  rules.review = Review::Duplicates;
  Scene scene(rules);
  scene.wait(16);
  scene.post(1);
  scene.post(2);
  scene.restart();
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.send_next(), 1);
  scene.answer(recorded_answer());
  scene.send_next();
  EXPECT_EQ(scene.state(2), Held);
}

TEST(MoveToAnotherCommandPost, AnswersClientsThatPostedBefore) {
  Scene scene;
  scene.restart("10.0.0.1:1");  // no status comes: queued reports are for the first Command Post that answers
  const ClientId client = scene.post_queued();
  scene.move_to("10.0.0.2:1");
  EXPECT_FALSE(scene.is_answered(client));
  scene.receive_status(20, 0);
  ASSERT_EQ(scene.send_next(), 1);
  scene.answer(recorded_answer(1));
  EXPECT_EQ(scene.answer_to(client).status, 201);
}

TEST(MoveToAnotherCommandPost, AnswersClientsOfTheOldOneAtTheirDeadline) {
  Scene scene;
  const ClientId client = scene.post_queued();
  scene.move_to("10.0.0.2:1");
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_FALSE(scene.is_answered(client));
  scene.wait(20);
  EXPECT_EQ(scene.answer_to(client).status, 503);
  scene.move_to("10.100.1.200:8000");
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(NewRules, ApplyToLaterClients) {
  Scene scene;
  const ClientId before = scene.post_queued(1);
  ReportRules rules;
  rules.answer_within = std::chrono::seconds{5};
  rules.review = Review::All;
  scene.reports().set_rules(rules);
  const ClientId after = scene.post_queued(100);
  EXPECT_EQ(scene.state(2), Held);
  scene.wait(5);
  EXPECT_TRUE(scene.is_answered(after));
  EXPECT_FALSE(scene.is_answered(before));
}

}  // namespace
/// The clock starts ahead of all earlier time stamps. That is no silence.
TEST(Reboot, IsNoSilence) {
  Scene scene;
  scene.repeat_status(12, 20, 0);
  scene.wait(10);
  scene.set_box_clock_forward(30);
  scene.restart();
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.reports().run().number, 1) << scene.reports().run().why;
}

}  // namespace adit::dispatch
