// Runs and their clocks: clocks that stand, and a clock that goes back.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;

/// The organiser's test server: its status always says 25.98 s, its answers 3.14 s, and the run is "1".
class StandingClocks : public testing::Test {
 protected:
  StandingClocks() {
    hear(20);
    record(1);
    hear(19);
  }
  void hear(std::int64_t remaining) { scene_.hear(remaining, 0, 25.98); }
  void record(double x) {
    scene_.post(x);
    scene_.answer(recorded(0, "scored", "1", 3.14));
  }
  Scene scene_;
};

TEST_F(StandingClocks, AreOneRunThroughout) {
  record(2);
  hear(18);
  scene_.wait(3600);
  hear(18);
  EXPECT_EQ(scene_.reports().run().number, 1);
}

TEST_F(StandingClocks, TheSameReportAgainGetsTheRecordedAnswer) {
  record(2);
  const ClientId again = scene_.post(1);
  EXPECT_EQ(scene_.count(), 2u);
  EXPECT_EQ(scene_.told(again).body, recorded(0, "scored", "1", 3.14).body);
}

TEST_F(StandingClocks, WhatWasRoundedToAFloat32IsTheSameReport) {
  record(12.3);
  scene_.post(12.3F);
  EXPECT_EQ(scene_.count(), 2u);
  scene_.post(12.302);
  EXPECT_EQ(scene_.count(), 3u);
}

TEST_F(StandingClocks, AreOneRunOverARestart) {
  scene_.restart();
  scene_.wait(3600);
  hear(19);
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 1u);
  EXPECT_EQ(scene_.reports().run().number, 1);
}

TEST_F(StandingClocks, AreAnotherRunWhereMoreReportsAreLeft) {
  hear(20);
  EXPECT_EQ(scene_.reports().run().number, 2);
  scene_.post(1);
  EXPECT_EQ(scene_.state(2), Sending);
}

/// A clock that ran goes back; as many reports are left as before.
class OnlyTheClock : public testing::Test {
 protected:
  OnlyTheClock() {
    scene_.record(1, "1");
    for (int i = 0; i < 2; ++i) {
      scene_.wait(1);
      scene_.hear(19, 0);
    }
    scene_.hear(19, 0, 3);
  }
  Scene scene_;
};

TEST_F(OnlyTheClock, MakesANewRunLikelyAndHoldsTheSameReport) {
  EXPECT_EQ(scene_.reports().run().number, 2);
  EXPECT_EQ(scene_.output().run->may_be, 1) << "on disk";
  const ClientId again = scene_.post(1);
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the same as report 1"));
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the run clock went back"));
  scene_.wait(21);
  EXPECT_THAT(scene_.told(again).sentence, HasSubstr("is held until the operator decides"));
  EXPECT_THAT(scene_.undecided(), testing::Contains(HasSubstr("the same as report 1")));
}

TEST_F(OnlyTheClock, HoldsItOverARestart) {
  scene_.restart();
  scene_.hear(19, 0, 4);
  scene_.post(1);
  EXPECT_EQ(scene_.state(2), Held);
}

TEST_F(OnlyTheClock, HoldsWhatWasPostedBeforeTheRunWasKnown) {
  scene_.wait(16);
  scene_.post(1);
  EXPECT_EQ(scene_.state(2), Queued);
  scene_.hear(19, 0, 20);
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_EQ(scene_.report(2).same_as, 1);
}

TEST_F(OnlyTheClock, SendsWhatIsNew) {
  scene_.post(2);
  EXPECT_EQ(scene_.state(2), Sending);
}

TEST_F(OnlyTheClock, LetsItGoOnceAnAnswerNamesAnotherRun) {
  scene_.post(1);
  scene_.record(2, "2");
  EXPECT_EQ(scene_.state(2), Queued);
  EXPECT_EQ(scene_.report(2).same_as, 0);
  EXPECT_EQ(scene_.reports().run().may_be, 0);
  EXPECT_EQ(scene_.send_next(), 2);
}

/// The clock goes back twice, and a report is found recorded in between.
class OnlyTheClockTwice : public OnlyTheClock {
 protected:
  OnlyTheClockTwice() {
    scene_.post(2);
    scene_.lose();
    for (int i = 0; i < 15; ++i) {
      scene_.wait(1);
      scene_.hear(18, 0, 4 + i);
    }
    scene_.hear(18, 0, 3);
  }
};

TEST_F(OnlyTheClockTwice, IsOneRunIfAnAnswerNamesTheFirst) {
  ASSERT_EQ(scene_.state(2), Settled);
  ASSERT_EQ(scene_.reports().run().number, 3);
  scene_.record(3, "1");
  EXPECT_EQ(scene_.reports().run().number, 1);
  for (const std::int64_t number : {1, 2, 3}) EXPECT_EQ(scene_.report(number).run, 1) << number;
  EXPECT_EQ(scene_.reports().run().last->remaining_reports, 18);
}

TEST_F(OnlyTheClockTwice, MayStillBeTheSecondIfAnAnswerNamesAnother) {
  scene_.post(2);
  scene_.post(1);
  scene_.record(3, "2");
  EXPECT_EQ(scene_.send_next(), 4) << "it is not the first run";
  scene_.answer(answer_of(201));
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(3), Held) << "it may have been recorded in this run";
  EXPECT_EQ(scene_.output().runs.at(2).may_be, 0) << "on disk";
}

TEST_F(OnlyTheClock, LetsItGoOnceMoreReportsAreLeft) {
  scene_.post(1);
  scene_.hear(25, 0, 4);
  EXPECT_EQ(scene_.reports().run().number, 3) << "run 2 may have been run 1";
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(OnlyTheClock, CountsAgainOnceMoreReportsAreLeft) {
  scene_.hear(25, 0, 4);
  for (int i = 0; i < 3; ++i) {
    scene_.wait(1);
    scene_.hear(25, 0, 5 + i);
  }
  EXPECT_EQ(scene_.reports().run().unreliable, "") << "nobody else reports";
}

TEST_F(OnlyTheClock, LetsItGoOnTheOperatorsWord) {
  scene_.post(1);
  ASSERT_TRUE(scene_.reports().send(2, scene_.time()));
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(OnlyTheClock, IsNoNewRunWhereAnAnswerGivesItsOldName) {
  const ClientId again = scene_.post(1);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.state(2), Withdrawn);
  EXPECT_EQ(scene_.report(2).same_as, 1);
  EXPECT_EQ(scene_.report(3).run, 1) << "all that was recorded is of the one run";
  EXPECT_EQ(scene_.told(again).status, 201) << "whoever still waits for it gets the recorded answer";
  EXPECT_EQ(scene_.told(scene_.post(1)).status, 201);
  EXPECT_EQ(scene_.told(scene_.post(2)).status, 201);
  EXPECT_EQ(scene_.count(), 3u);
}

/// Report 1 was never recorded, and the operator has sent the same as report 2 meanwhile.
TEST(OnlyTheClockInDoubt, DoesNotSendAgainWhatTheOperatorSentOnceMore) {
  Scene scene;
  scene.post(7);
  scene.answer(recorded(0, "scored", "1"));
  scene.wait(1);
  scene.hear(19, 0);
  scene.post(1);
  scene.lose();
  for (int i = 0; i < 40; ++i) {
    scene.wait(1);
    scene.hear(19, 0, 102);
  }
  scene.hear(19, 0, 3);
  ASSERT_EQ(scene.reports().run().number, 2);
  scene.post(1);
  ASSERT_EQ(scene.state(3), Held);
  ASSERT_TRUE(scene.reports().send(3, scene.time()));
  ASSERT_EQ(scene.send_next(), 3);
  scene.answer(recorded(0, "scored", "1"));
  ASSERT_EQ(scene.reports().run().number, 1) << "it is the run that was before";
  ASSERT_EQ(scene.state(2), InDoubt);
  scene.keep_hearing(30, 18, 0);
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_EQ(scene.state(2), Held);
  EXPECT_THAT(scene.report(2).note, HasSubstr("report 3 is the same and is answered in this run"));
}

TEST_F(OnlyTheClock, TheRunThatIsBackIsSoAfterARestart) {
  scene_.record(2, "1");
  scene_.restart();
  scene_.hear(18, 0, 5);
  EXPECT_EQ(scene_.reports().run().number, 1);
  scene_.post(2);
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 2u);
}

TEST_F(OnlyTheClock, DoesNotReleaseWhatTheReviewHolds) {
  ReportRules rules;
  rules.review = Review::All;
  Scene scene(rules);
  scene.post(1);
  scene.post(2);
  ASSERT_TRUE(scene.reports().send(1, scene.time()));
  ASSERT_EQ(scene.send_next(), 1);
  scene.answer(recorded(0, "scored", "1"));
  EXPECT_EQ(scene.state(2), Held);
}

}  // namespace
}  // namespace adit::dispatch
