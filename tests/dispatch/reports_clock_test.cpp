// Run clocks that stand or go back.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;

/// The organiser's test server: each status shows 25.98 s, each answer 3.14 s and run "1".
class StandingClocks : public testing::Test {
 protected:
  StandingClocks() {
    receive_status(20);
    record(1);
    receive_status(19);
  }
  void receive_status(std::int64_t remaining) { scene_.receive_status(remaining, 0, 25.98); }
  void record(double x) {
    scene_.post(x);
    scene_.answer(recorded_answer(0, "scored", "1", 3.14));
  }
  Scene scene_;
};

TEST_F(StandingClocks, GiveARepeatTheRecordedAnswer) {
  record(2);
  const ClientId again = scene_.post(1);
  EXPECT_EQ(scene_.count(), 2u);
  EXPECT_EQ(scene_.answer_to(again).body, recorded_answer(0, "scored", "1", 3.14).body);
}

TEST_F(StandingClocks, AreOneRunAcrossARestart) {
  scene_.restart();
  scene_.wait(3600);
  receive_status(19);
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 1u);
  EXPECT_EQ(scene_.reports().run().number, 1);
}

/// A running clock goes back; the reports left are unchanged.
class ClockSetBack : public testing::Test {
 protected:
  ClockSetBack() {
    scene_.record(1, "1");
    for (int i = 0; i < 2; ++i) {
      scene_.wait(1);
      scene_.receive_status(19, 0);
    }
    scene_.wait(3);
    scene_.receive_status(19, 0, 3);
  }
  Scene scene_;
};

TEST_F(ClockSetBack, MakesANewRunLikelyAndHoldsARepeat) {
  EXPECT_EQ(scene_.reports().run().number, 2);
  EXPECT_EQ(scene_.output().run->may_be, 1) << "on disk";
  const ClientId again = scene_.post(1);
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the same as report 1"));
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the run clock went back"));
  scene_.wait(21);
  EXPECT_THAT(scene_.answer_to(again).sentence, HasSubstr("is held until the operator decides"));
  EXPECT_THAT(scene_.undecided(), testing::Contains(HasSubstr("the same as report 1")));
}

TEST_F(ClockSetBack, HoldsARepeatAfterARestart) {
  scene_.restart();
  scene_.receive_status(19, 0, 4);
  scene_.post(1);
  EXPECT_EQ(scene_.state(2), Held);
}

TEST_F(ClockSetBack, HoldsARepeatPostedBeforeTheRunIsKnown) {
  scene_.wait(16);
  scene_.post(1);
  EXPECT_EQ(scene_.state(2), Queued);
  scene_.receive_status(19, 0, 20);
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_EQ(scene_.report(2).same_as, 1);
}

TEST_F(ClockSetBack, SendsANewReport) {
  scene_.post(2);
  EXPECT_EQ(scene_.state(2), Sending);
}

TEST_F(ClockSetBack, SendsTheRepeatIfAnAnswerNamesAnotherRun) {
  scene_.post(1);
  scene_.record(2, "2");
  EXPECT_EQ(scene_.state(2), Queued);
  EXPECT_EQ(scene_.report(2).same_as, 0);
  EXPECT_EQ(scene_.reports().run().may_be, 0);
  EXPECT_EQ(scene_.send_next(), 2);
}

/// The clock goes back twice; a report is reconciled in between.
class ClockSetBackTwice : public ClockSetBack {
 protected:
  ClockSetBackTwice() {
    scene_.post(2);
    scene_.lose_answer();
    for (int i = 0; i < 15; ++i) {
      scene_.wait(1);
      scene_.receive_status(18, 0, 4 + i);
    }
    scene_.receive_status(18, 0, 3);
  }
};

TEST_F(ClockSetBackTwice, IsOneRunIfAnAnswerNamesTheFirst) {
  ASSERT_EQ(scene_.state(2), Settled);
  ASSERT_EQ(scene_.reports().run().number, 3);
  scene_.record(3, "1");
  EXPECT_EQ(scene_.reports().run().number, 1);
  for (const std::int64_t number : {1, 2, 3}) EXPECT_EQ(scene_.report(number).run, 1) << number;
  EXPECT_EQ(scene_.reports().run().last->remaining_reports, 18);
}

TEST_F(ClockSetBackTwice, MayBeTheSecondRunIfAnAnswerNamesAnother) {
  scene_.post(2);
  scene_.post(1);
  scene_.record(3, "2");
  EXPECT_EQ(scene_.send_next(), 4) << "the answer is not of the first run";
  scene_.answer(answer_of(201));
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(3), Held) << "it may be recorded in this run";
  EXPECT_EQ(scene_.output().runs.at(2).may_be, 0) << "on disk";
}

TEST_F(ClockSetBack, HoldsTheRepeatIfMoreReportsAreLeft) {
  scene_.post(1);
  scene_.wait(1);
  scene_.receive_status(25, 0, 4);
  EXPECT_EQ(scene_.reports().run().number, 2) << "the clock goes on";
  EXPECT_EQ(scene_.send_next(), 0);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.state(2), Held) << "two signs: some servers give all runs one name";
}

TEST_F(ClockSetBack, TrustsTheCountAgainIfMoreReportsAreLeft) {
  scene_.receive_status(25, 0, 4);
  for (int i = 0; i < 3; ++i) {
    scene_.wait(1);
    scene_.receive_status(25, 0, 5 + i);
  }
  EXPECT_EQ(scene_.reports().run().unreliable, "") << "no other sender";
}

TEST_F(ClockSetBack, IsNoNewRunIfAnAnswerHasTheOldName) {
  const ClientId again = scene_.post(1);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.state(2), Withdrawn);
  EXPECT_EQ(scene_.report(2).same_as, 1);
  EXPECT_EQ(scene_.report(3).run, 1) << "all are of one run";
  EXPECT_EQ(scene_.answer_to(again).status, 201);
  EXPECT_EQ(scene_.answer_to(scene_.post(1)).status, 201);
  EXPECT_EQ(scene_.answer_to(scene_.post(2)).status, 201);
  EXPECT_EQ(scene_.count(), 3u);
}

/// Report 2 was never recorded, and the operator sent the same report as number 3.
TEST(DoubtAndClockSetBack, DoesNotResendAReportThatTheOperatorSent) {
  Scene scene;
  scene.post(7);
  scene.answer(recorded_answer(0, "scored", "1"));
  scene.wait(1);
  scene.receive_status(19, 0);
  scene.post(1);
  scene.lose_answer();
  for (int i = 0; i < 40; ++i) {
    scene.wait(1);
    scene.receive_status(19, 0, 102);
  }
  scene.receive_status(19, 0, 3);
  ASSERT_EQ(scene.reports().run().number, 2);
  scene.post(1);
  ASSERT_EQ(scene.state(3), Held);
  ASSERT_TRUE(scene.reports().send(3, scene.time()));
  ASSERT_EQ(scene.send_next(), 3);
  scene.answer(recorded_answer(0, "scored", "1"));
  ASSERT_EQ(scene.reports().run().number, 1) << "the old run";
  ASSERT_EQ(scene.state(2), InDoubt);
  scene.repeat_status(30, 18, 0);
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_EQ(scene.state(2), Held);
  EXPECT_THAT(scene.report(2).note, HasSubstr("report 3 is the same and is answered in this run"));
}

TEST_F(ClockSetBack, KeepsTheOldRunAfterARestart) {
  scene_.record(2, "1");
  scene_.restart();
  scene_.receive_status(18, 0, 5);
  EXPECT_EQ(scene_.reports().run().number, 1);
  scene_.post(2);
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 2u);
}

}  // namespace
}  // namespace adit::dispatch
