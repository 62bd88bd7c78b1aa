// A new run, and what it does to the reports of the one before.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ANewRun, IsNoticedByAClockThatRanBackward) {
  Scene scene;
  scene.wait(10);
  scene.hear(20, 0);
  scene.hear(20, 0, 3);
  EXPECT_EQ(scene.reports().run().number, 2);
  EXPECT_EQ(scene.output().run->number, 2);
  EXPECT_THAT(scene.output().run->why, HasSubstr("the run clock went back"));
}

TEST(ANewRun, IsNoticedByMoreReportsLeft) {
  Scene scene;
  scene.wait(10);
  scene.hear(25, 0);
  EXPECT_EQ(scene.reports().run().number, 2);
  EXPECT_THAT(scene.output().run->why, HasSubstr("the reports left went up from 20 to 25"));
  EXPECT_EQ(scene.output().run->last->remaining_reports, 25);
}

TEST(ANewRun, IsNoticedByAnotherTeam) {
  Scene scene;
  scene.reports().status_heard({0, 101, 20, "other"}, scene.time().now, scene.time());
  EXPECT_EQ(scene.reports().run().number, 2);
}

TEST(ANewRun, IsNoticedByTheRunOfAnAnswer) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded(0, "scored", "1", 101));
  scene.post(2);
  scene.wait(12);
  scene.answer(recorded(0, "scored", "2", 113));
  EXPECT_EQ(scene.reports().run().number, 2);
  EXPECT_EQ(scene.reports().run().id, "2");
  EXPECT_EQ(scene.report(1).run, 1);
  EXPECT_EQ(scene.report(2).run, 2) << "it was recorded in the run that answered";
}

TEST(ANewRun, IsNotSeenInTheClockOfTheBoxBeingSet) {
  Scene scene;
  scene.wait(5);
  scene.set_box_clock_forward(7200);
  scene.hear(20, 0);
  EXPECT_EQ(scene.reports().run().number, 1);
}

TEST(ANewRun, IsTakenUpAfterARestart) {
  Scene scene;
  scene.hear(25, 0, 3);
  scene.restart();
  EXPECT_EQ(scene.reports().run().number, 2);
}

TEST(ANewRun, HoldsWhatWaitsFromTheRunBefore) {
  Scene scene;
  scene.post_to_wait(1);
  scene.wait(11);
  scene.hear(25, 0, 3);
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_THAT(scene.report(1).note, HasSubstr("a new run began (the reports left went up"));
  EXPECT_EQ(scene.output().ledger.at(1).state, Held) << "written down with the run";
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 1) << "the operator asks for it";
  EXPECT_EQ(scene.report(1).run, 2);
}

TEST(ANewRun, IsEnteredByWhatWasPostedJustNow) {
  Scene scene;
  scene.post_to_wait(1);
  scene.wait(9);
  scene.hear(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 2);
  EXPECT_EQ(scene.output().ledger.at(1).run, 2);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(ANewRun, IsEnteredByAnOldReportThatWasPostedAgainJustNow) {
  Scene scene;
  scene.post_to_wait(1);
  scene.wait(60);
  scene.post(1);
  scene.wait(5);
  scene.hear(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 2);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(ANewRun, HoldsEvenTheReportsThatWereSentOnPurposeInTheOneBefore) {
  Scene scene;
  scene.post_to_wait(1);
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  scene.wait(11);
  scene.hear(25, 0, 3);
  EXPECT_EQ(scene.state(1), Held);
}

TEST(ANewRun, TakesTheSameReportAsANewOne) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded());
  scene.hear(19, 0);
  scene.hear(25, 0, 3);
  scene.post(1);
  EXPECT_EQ(scene.state(2), Sending);
  EXPECT_EQ(scene.report(2).run, 2);
}

TEST(ANewRun, MakesADoubtUndecidable) {
  Scene scene;
  scene.post(1);
  scene.lose();
  scene.wait(5);
  scene.hear(25, 0, 3);
  EXPECT_FALSE(scene.reports().is_asking(scene.report(1)));
  scene.keep_hearing(30, 25, 0);
  EXPECT_EQ(scene.state(1), InDoubt);
  EXPECT_THAT(scene.report(1).note, HasSubstr("the operator decides"));
}

TEST(ADoubt, ThatMayBeRecordedInTheNewRunStandsForTheSameReportThere) {
  Scene scene;
  scene.post(1);
  scene.lose();
  scene.wait(5);
  scene.hear(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 2);
  EXPECT_EQ(scene.report(1).before, std::nullopt) << "which was counted in the run before";
  const ClientId again = scene.post(1);
  EXPECT_EQ(scene.count(), 1);
  scene.wait(20);
  EXPECT_EQ(scene.told(again).status, 504);
}

TEST(ADoubt, ThatIsOlderThanTheLastWordOfItsRunStaysThere) {
  Scene scene;
  scene.post(1);
  scene.lose();
  for (int i = 0; i < 30; ++i) {
    scene.wait(1);
    scene.hear(20, 0, 101);  // a stop: it stays in doubt
  }
  scene.hear(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 1);
  EXPECT_THAT(scene.report(1).note, HasSubstr("a new run began before the status showed"));
  scene.post(1);
  EXPECT_EQ(scene.state(2), Sending) << "the new run has nothing of it";
}

TEST(ADeclaredRun, BeginsLikeOneThatIsNoticed) {
  Scene scene;
  scene.post_to_wait(1);
  scene.wait(11);
  EXPECT_EQ(scene.reports().declare_new_run(scene.time()), 2);
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_EQ(scene.output().run->why, "the operator declared it");
  scene.hear(25, 0, 3);
  EXPECT_EQ(scene.reports().run().number, 2) << "the clock is no news";
}

/// Declared while a report was under way, which may be recorded in either.
class DeclaredMeanwhile : public testing::Test {
 protected:
  DeclaredMeanwhile() {
    scene_.post(1);
    scene_.wait(12);
    scene_.reports().declare_new_run(scene_.time());
  }
  Scene scene_;
};

TEST_F(DeclaredMeanwhile, ItsRepeatJoinsIt) {
  const ClientId again = scene_.post(1);
  EXPECT_EQ(scene_.count(), 1);
  scene_.answer(recorded());
  EXPECT_EQ(scene_.told(again).status, 201);
  EXPECT_EQ(scene_.report(1).run, 2);
}

TEST_F(DeclaredMeanwhile, ItsDoubtStandsForItInTheNewRun) {
  scene_.lose();
  EXPECT_EQ(scene_.report(1).run, 2);
  EXPECT_EQ(scene_.report(1).before, std::nullopt);
  scene_.hear(25, 0, 3);
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 1);
}

TEST_F(DeclaredMeanwhile, ItDoesNotGoAgainByItself) {
  scene_.answer(answer_of(429));
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(1), Held);
}

TEST_F(DeclaredMeanwhile, ItGoesAgainWhereSomebodyPostedItSince) {
  scene_.post(1);
  scene_.answer(answer_of(429));
  EXPECT_EQ(scene_.send_next(), 1);
  EXPECT_EQ(scene_.report(1).run, 2);
}

TEST_F(DeclaredMeanwhile, AndTheProgramEnded) {
  scene_.restart();
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_EQ(scene_.report(1).run, 2);
  EXPECT_EQ(scene_.report(1).before, std::nullopt);
}

TEST(ACommandPost, WithoutAStatusIsSentWhatIsPostedNow) {
  Scene scene;
  scene.wait(16);
  scene.post(1);
  EXPECT_EQ(scene.send_next(), 0);
  scene.reports().status_failed(true, scene.time());
  EXPECT_EQ(scene.send_next(), 1);
  scene.answer(answer_of(429));
  scene.wait(11);
  scene.reports().status_failed(true, scene.time());
  EXPECT_EQ(scene.send_next(), 0) << "it may be meant for a run that has ended";
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 1) << "the operator knows";
}

TEST(ACommandPost, ThatCannotBeReachedIsSentNothing) {
  Scene scene;
  scene.wait(16);
  scene.post(1);
  scene.reports().status_failed(false, scene.time());
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_THAT(scene.undecided(), IsEmpty());
}

}  // namespace
}  // namespace adit::dispatch
