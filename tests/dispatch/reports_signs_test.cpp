// The table "A new run" of dispatch/README.md: what counts, clocks and names do to a repeat of a recorded
// report, to queued reports and to doubts.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;
using testing::IsEmpty;

/// Report 1 is recorded in run "1", with a point. 19 reports are left, and the score is 1, at 101 s.
class RunOne : public testing::Test {
 protected:
  RunOne() {
    scene_.post(1);
    scene_.answer(recorded_answer(1, "scored", "1"));
    pass(1, 19, 1);
  }
  /// A status after that time, by the clock of the run.
  void pass(double seconds, std::int64_t remaining, std::int64_t score) {
    scene_.wait(seconds);
    scene_.receive_status(remaining, score);
  }
  /// The same, with another clock.
  void pass(double seconds, std::int64_t remaining, std::int64_t score, double clock) {
    scene_.wait(seconds);
    scene_.receive_status(remaining, score, clock);
  }
  /// Report `number`, a repeat of report 1, is held.
  void expect_held_repeat(std::int64_t number) {
    scene_.post(1);
    ASSERT_EQ(scene_.count(), static_cast<std::size_t>(number));
    EXPECT_EQ(scene_.state(number), Held);
    EXPECT_EQ(scene_.report(number).same_as, 1);
  }
  void expect_recorded_answer() {
    const std::size_t count = scene_.count();
    EXPECT_EQ(scene_.answer_to(scene_.post(1)).status, 201);
    EXPECT_EQ(scene_.count(), count);
  }
  Scene scene_;
};

// Count up, and the clock goes on.

using GrantedReport = RunOne;

TEST_F(GrantedReport, GivesARepeatTheRecordedAnswer) {
  pass(10, 20, 1);
  EXPECT_EQ(scene_.reports().run().number, 1);
  expect_recorded_answer();
  scene_.record(2, "1");
  expect_recorded_answer();
}

TEST_F(GrantedReport, GivesARepeatTheRecordedAnswerIfNoNameIsKnown) {
  Scene nameless;
  nameless.record(1, "");
  nameless.wait(1);
  nameless.receive_status(19, 0);
  nameless.wait(10);
  nameless.receive_status(22, 0);
  EXPECT_EQ(nameless.answer_to(nameless.post(1)).status, 201);
  EXPECT_EQ(nameless.count(), 1u);
}

TEST_F(GrantedReport, HoldsNoQueuedReport) {
  scene_.post_queued(2);
  for (int i = 0; i < 12; ++i) pass(1, 19, 1);
  pass(1, 20, 1);
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(GrantedReport, IsInTheCountThatDecidesTheNextDoubt) {
  pass(10, 22, 1);
  scene_.post(2);
  scene_.lose_answer();
  pass(1, 21, 1);
  pass(1, 21, 1);
  EXPECT_EQ(scene_.state(2), Settled);
  EXPECT_THAT(scene_.reports().run().unreliable, IsEmpty());
}

/// The report is recorded, and another one is granted: the count looks as if it was not recorded.
TEST_F(GrantedReport, LeavesADoubtToTheOperator) {
  scene_.post(2);
  scene_.lose_answer();
  pass(1, 18, 1);
  for (int i = 0; i < 20; ++i) pass(1, 19, 1);
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(2), InDoubt);
  EXPECT_EQ(scene_.output().ledger.at(2).before, std::nullopt) << "on disk";
  EXPECT_THAT(
      scene_.report(2).note,
      HasSubstr("the reports left went up from 18 to 19 while it was in doubt; the operator decides"));
  EXPECT_FALSE(scene_.reports().is_asking(scene_.report(2)));
  scene_.restart();
  for (int i = 0; i < 20; ++i) pass(1, 19, 1);
  EXPECT_EQ(scene_.state(2), InDoubt);
}

TEST_F(GrantedReport, LeavesADoubtToTheOperatorEvenIfTheDiskIsFull) {
  scene_.post(2);
  scene_.lose_answer();
  pass(1, 18, 1);
  scene_.output().full = true;
  pass(1, 19, 1);
  scene_.output().full = false;
  for (int i = 0; i < 20; ++i) pass(1, 19, 1);
  EXPECT_EQ(scene_.state(2), InDoubt);
}

// Count up alone.

using CountUpAlone = RunOne;

TEST_F(CountUpAlone, HoldsARepeatUntilTheSameNameEndsIt) {
  pass(10, 20, 1, 101);
  expect_held_repeat(2);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.state(2), Withdrawn);
  expect_recorded_answer();
}

TEST_F(CountUpAlone, SendsTheRepeatIfAnAnswerNamesAnotherRun) {
  pass(10, 20, 1, 101);
  expect_held_repeat(2);
  scene_.record(2, "2");
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(CountUpAlone, HoldsARepeatWithoutAName) {
  pass(10, 20, 1, 101);
  scene_.record(2, "");
  expect_held_repeat(3);
  for (int i = 0; i < 100; ++i) pass(1, 19, 1);
  EXPECT_EQ(scene_.state(3), Held);
}

TEST_F(CountUpAlone, IsTheSignAfterASilenceInWhichAnotherRunMayHaveBegun) {
  pass(31, 20, 1);
  EXPECT_EQ(scene_.reports().run().may_be, 1);
  expect_held_repeat(2);
}

TEST_F(CountUpAlone, QueuesHeldReportsAgainIfTheSameNameEndsIt) {
  scene_.post_queued(2);
  for (int i = 0; i < 12; ++i) pass(1, 19, 1);
  pass(1, 20, 1, scene_.run_clock());
  ASSERT_EQ(scene_.state(2), Held);
  scene_.record(3, "1");
  EXPECT_EQ(scene_.state(2), Queued);
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(CountUpAlone, LeavesHeldReportsToTheOperatorIfHeHeldThem) {
  scene_.post_queued(2);
  for (int i = 0; i < 12; ++i) pass(1, 19, 1);
  pass(1, 20, 1, scene_.run_clock());
  scene_.wait(1);
  ASSERT_TRUE(scene_.reports().send(2, scene_.time()));
  ASSERT_TRUE(scene_.reports().hold(2, scene_.time()));
  scene_.record(3, "1");
  EXPECT_EQ(scene_.state(2), Held);
}

/// A client repeats the held report, and the repeat is sent (seed 1932920237 of the simulation).
TEST_F(CountUpAlone, QueuesNoHeldReportAgainIfItsRepeatWasSent) {
  scene_.post_queued(2);
  for (int i = 0; i < 12; ++i) pass(1, 19, 1);
  pass(1, 20, 1, scene_.run_clock());
  ASSERT_EQ(scene_.state(2), Held);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(2), Held);
}

TEST_F(CountUpAlone, LeavesAnOlderDoubtToTheOperator) {
  scene_.post(2);
  scene_.lose_answer();
  for (int i = 0; i < 30; ++i) pass(1, 19, 1, 102);
  pass(1, 20, 1, 102);
  scene_.record(3, "1");
  ASSERT_EQ(scene_.report(2).run, 1);
  for (int i = 0; i < 30; ++i) pass(1, 19, 1);
  EXPECT_EQ(scene_.state(2), InDoubt) << "the count rose while it was in doubt";
}

// Two signs.

using TwoSigns = RunOne;

TEST_F(TwoSigns, SendTheRepeatIfAnAnswerNamesAnotherRun) {
  pass(10, 25, 0, 3);
  expect_held_repeat(2);
  scene_.record(2, "2");
  EXPECT_EQ(scene_.reports().run().may_be, 0);
  EXPECT_EQ(scene_.send_next(), 2);
}

/// Some servers give all runs one name.
TEST_F(TwoSigns, LeaveTheRepeatToTheOperatorIfTheNameStays) {
  pass(10, 25, 0, 3);
  expect_held_repeat(2);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.reports().run().number, 2);
  EXPECT_EQ(scene_.state(2), Held);
  scene_.record(3, "1");
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_EQ(scene_.answer_to(scene_.post(3)).status, 201) << "a repeat in this run";
  ASSERT_TRUE(scene_.reports().send(2, scene_.time()));
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(TwoSigns, TellTheOperatorThatTheNameStays) {
  pass(10, 25, 0, 3);
  scene_.record(2, "1");
  scene_.post(1);
  EXPECT_THAT(scene_.report(3).note, HasSubstr("a new run is not certain (the run clock went back"));
  EXPECT_THAT(scene_.report(3).note, HasSubstr("the Command Post gives both runs the same name"));
}

TEST_F(TwoSigns, AreTheOperatorsWithoutAName) {
  pass(10, 25, 0, 3);
  scene_.record(2, "");
  expect_held_repeat(3);
  scene_.restart();
  scene_.receive_status(24, 0, 4);
  EXPECT_EQ(scene_.state(3), Held);
}

TEST_F(TwoSigns, AreCountAndScoreAlthoughTheClockGoesOn) {
  pass(10, 25, 0);
  expect_held_repeat(2);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.state(2), Held);
}

TEST_F(TwoSigns, MayBeFarApart) {
  pass(10, 19, 1, 3);
  pass(10, 25, 1, 13);
  expect_held_repeat(2);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_EQ(scene_.output().runs.at(2).signs, (Signs{.count = true, .clock = true})) << "on disk";
}

TEST_F(TwoSigns, MayBeOfTwoRuns) {
  pass(10, 20, 1, 101);
  pass(1, 20, 1, 102);
  pass(10, 20, 1, 3);
  ASSERT_EQ(scene_.reports().run().number, 3);
  expect_held_repeat(2);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.state(2), Held);
}

/// Report 2 is answered between the last status of the one run and the first of the next, both named "1".
TEST_F(TwoSigns, LeaveARepeatOfAnAnswerBetweenThemToTheOperator) {
  scene_.record(2, "1");
  pass(10, 25, 0, 3);
  scene_.post(2);
  ASSERT_EQ(scene_.state(3), Held);
  scene_.record(3, "1");
  EXPECT_EQ(scene_.state(3), Held);
  scene_.post(2);
  EXPECT_EQ(scene_.count(), 4u) << "it joins the held one";
}

// Clock back alone: reports_clock_test.cpp.

// Score back alone.

using ScoreBackAlone = RunOne;

TEST_F(ScoreBackAlone, IsACorrectionWhileTheClockGoesOn) {
  pass(10, 19, 0);
  EXPECT_EQ(scene_.reports().run().number, 1);
  expect_recorded_answer();
}

TEST_F(ScoreBackAlone, HoldsARepeatUntilTheSameNameEndsIt) {
  pass(10, 19, 0, 101);
  expect_held_repeat(2);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.state(2), Withdrawn);
}

// Another name.

using AnotherNameAlone = RunOne;

TEST_F(AnotherNameAlone, HoldsARepeatUntilAStatusConfirmsIt) {
  scene_.record(2, "2");
  EXPECT_EQ(scene_.reports().run().number, 2);
  expect_held_repeat(3);
  pass(1, 24, 0, 3);
  EXPECT_EQ(scene_.send_next(), 3);
  EXPECT_THAT(scene_.reports().run().name_trouble, IsEmpty());
}

TEST_F(AnotherNameAlone, IsARenamedRunIfCountAndClockGoOn) {
  scene_.record(2, "2");
  expect_held_repeat(3);
  pass(1, 18, 1);
  EXPECT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.report(2).run, 1);
  EXPECT_EQ(scene_.state(3), Held);
  EXPECT_EQ(
      scene_.output().runs.at(1).name_trouble,
      "the Command Post calls it run \"2\", it was \"1\"; but its count of reports and its clock go on");
  scene_.post(2);
  EXPECT_EQ(scene_.state(4), Held) << "names prove nothing any more";
  scene_.record(3, "3");
  EXPECT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.state(5), Answered);
  pass(1, 17, 1);
  EXPECT_EQ(scene_.reports().run().number, 1);
}

TEST_F(AnotherNameAlone, ReleasesQueuedReportsIfCountAndClockGoOn) {
  scene_.post_queued(2);
  for (int i = 0; i < 12; ++i) pass(1, 19, 1);
  scene_.post(3);
  ASSERT_EQ(scene_.send_next(), 2);
  scene_.answer(answer_of(429));
  scene_.post_queued(4);
  ASSERT_EQ(scene_.send_next(), 2);
  scene_.answer(recorded_answer(0, "scored", "2"));
  scene_.wait(0.5);
  pass(0.5, 18, 1);
  EXPECT_EQ(scene_.send_next(), 3);
}

TEST_F(AnotherNameAlone, InEachAnswerKeepsRepeatsHeld) {
  for (int i = 2; i < 8; ++i) scene_.record(i, icd::sentence(i));
  for (int i = 1; i < 8; ++i) scene_.post(i);
  for (std::int64_t i = 8; i < 14; ++i) EXPECT_EQ(scene_.state(i), Held) << i;
  pass(1, 13, 1);
  EXPECT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.send_next(), 0);
  for (std::int64_t i = 1; i < 8; ++i) EXPECT_EQ(scene_.report(i).run, 1) << i;
}

TEST_F(AnotherNameAlone, StaysARenamedRunAfterARestart) {
  scene_.record(2, "2");
  pass(1, 18, 1);
  scene_.restart();
  pass(1, 18, 1);
  scene_.post(1);
  EXPECT_EQ(scene_.state(3), Held);
}

/// Names prove nothing, so that another one does not confirm the clock's sign.
TEST_F(AnotherNameAlone, ConfirmsNoSignInARenamedRun) {
  scene_.record(2, "2");
  pass(1, 18, 1);
  pass(10, 18, 1, 50);
  ASSERT_EQ(scene_.reports().run().may_be, 1);
  scene_.record(3, "3");
  scene_.post(1);
  EXPECT_EQ(scene_.state(4), Held);
  EXPECT_EQ(scene_.send_next(), 0);
}

/// As after a start while the status failed and the disk was full.
TEST_F(AnotherNameAlone, HoldsARepeatIfNoEarlierStatusIsKnown) {
  auto run = scene_.reports().run();
  run.last.reset();
  run.status_clock.reset();
  scene_.output().runs[1] = run;
  scene_.restart();
  scene_.reports().on_status_failed(NoStatus::Other, scene_.time());
  scene_.post_queued(2);
  ASSERT_EQ(scene_.send_next(), 2);
  scene_.answer(recorded_answer(0, "scored", "2"));
  expect_held_repeat(3);
  for (int i = 0; i < 30; ++i) pass(1, 18, 1);
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(3), Held);
}

/// A referee sets the clock of a run, and the server gives each answer another name.
using ClockAndName = RunOne;

TEST_F(ClockAndName, HoldARepeatIfTheNameCameFirst) {
  scene_.record(2, "2");
  expect_held_repeat(3);
  pass(1, 18, 1, 50);
  EXPECT_EQ(scene_.state(3), Held);
  EXPECT_EQ(scene_.send_next(), 0);
}

TEST_F(ClockAndName, HoldARepeatIfTheClockCameFirst) {
  pass(1, 19, 1, 50);
  expect_held_repeat(2);
  scene_.record(3, "2");
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_EQ(scene_.send_next(), 0);
  scene_.record(4, "2");
  EXPECT_EQ(scene_.state(2), Held) << "the name stays";
}

TEST_F(AnotherNameAlone, EndsWithTheFirstNameBeforeAStatus) {
  scene_.record(2, "2");
  scene_.record(3, "1");
  EXPECT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.report(2).run, 1);
  expect_recorded_answer();
}

// The team's and the operator's word.

TEST_F(RunOne, AreNeverUndoneIfTheTeamChanges) {
  scene_.wait(1);
  scene_.reports().on_status({1, 102, 19, "other"}, scene_.time().now, scene_.time());
  scene_.record(2, "1");
  EXPECT_EQ(scene_.reports().run().number, 2);
  scene_.post(1);
  EXPECT_EQ(scene_.state(3), Sending);
}

TEST_F(RunOne, AreNeverUndoneIfTheOperatorDeclaredARun) {
  scene_.reports().declare_new_run(scene_.time());
  scene_.record(2, "1");
  EXPECT_EQ(scene_.reports().run().number, 2);
  pass(1, 18, 1);
  EXPECT_EQ(scene_.reports().run().number, 2);
  scene_.post(1);
  EXPECT_EQ(scene_.state(3), Sending);
}

}  // namespace
}  // namespace adit::dispatch
