// The operator's word.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

/// In which states a word is taken.
struct Words {
  ReportState state;
  bool send, hold, withdraw, done, resubmit;
};
void PrintTo(const Words& words, std::ostream* out) {
  *out << name_of(words.state);
}

const Words kWords[] = {
    {Held, true, false, true, false, false},      {Queued, true, true, true, false, false},
    {Sending, false, false, false, false, false}, {Answered, false, false, false, false, true},
    {Rejected, true, false, false, false, true},  {InDoubt, true, false, false, true, false},
    {Settled, false, false, false, false, true},  {Withdrawn, true, false, false, false, true},
};

class OperatorsWord : public testing::TestWithParam<Words> {
 protected:
  /// In a world of its own: whether `say` moved a report in that state. If not, it is untouched.
  template <class Say>
  bool taken(Say say) {
    Scene scene;
    Report report;
    report.number = 1;
    report.run = 1;
    report.state = GetParam().state;
    scene.output().ledger[1] = report;
    if (report.state == Sending) {
      scene.post();
    } else {
      scene.restart();
    }
    const Report before = scene.report(1);
    const auto outcome = say(scene.reports(), scene.time());
    if (!outcome) {
      EXPECT_EQ(scene.report(1), before);
      EXPECT_THAT(outcome.error(), HasSubstr("report 1 is " + std::string(shown_name_of(GetParam().state))));
    }
    return outcome.has_value();
  }
};

TEST_P(OperatorsWord, IsTakenWhereTheTableHasIt) {
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.send(1, time); }), GetParam().send);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.hold(1, time); }), GetParam().hold);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.withdraw(1, time); }), GetParam().withdraw);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.settle(1, time); }), GetParam().done);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.resubmit(1, time); }), GetParam().resubmit);
}
INSTANTIATE_TEST_SUITE_P(States, OperatorsWord, testing::ValuesIn(kWords));

TEST(TheOperator, IsToldWhereThereIsNoSuchReport) {
  Scene scene;
  const std::string none = "there is no report 7";
  EXPECT_EQ(scene.reports().send(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().hold(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().withdraw(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().settle(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().resubmit(7, scene.time()).error(), none);
}

TEST(Holding, KeepsAReportBackUntilTheOperatorSendsIt) {
  Scene scene;
  const ClientId client = scene.post_to_wait();
  ASSERT_TRUE(scene.reports().hold(1, scene.time()).has_value());
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_EQ(scene.report(1).note, "the operator held it");
  EXPECT_EQ(scene.told(client).status, 503);
  EXPECT_THAT(scene.told(client).sentence, HasSubstr("is held until the operator decides"));
  EXPECT_THAT(scene.undecided(), ElementsAre("the operator held it"));
  scene.keep_hearing(60, 20, 0);
  EXPECT_EQ(scene.send_next(), 0);
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(Holding, HoldsWhatOutlivesARestartToo) {
  Scene scene;
  scene.post_to_wait();
  ASSERT_TRUE(scene.reports().hold(1, scene.time()).has_value());
  scene.restart();
  scene.hear(20, 0);
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_EQ(scene.send_next(), 0);
}

TEST(Holding, HoldsTheSameReportPostedAgainWithIt) {
  Scene scene;
  scene.post_to_wait();
  ASSERT_TRUE(scene.reports().hold(1, scene.time()).has_value());
  const ClientId again = scene.post();
  EXPECT_EQ(scene.count(), 1);
  scene.wait(21);
  EXPECT_EQ(scene.told(again).status, 503);
  EXPECT_EQ(scene.send_next(), 0);
}

TEST(Holding, LetsTheOthersGo) {
  Scene scene;
  scene.post_to_wait(1);
  scene.post_to_wait(2);
  ASSERT_TRUE(scene.reports().hold(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 2);
}

TEST(Holding, SaysWhyItIsTooLate) {
  Scene scene;
  scene.post(1);
  EXPECT_THAT(scene.reports().hold(1, scene.time()).error(),
              HasSubstr("is sending: it may have been sent already"));
  scene.lose();
  EXPECT_THAT(scene.reports().hold(1, scene.time()).error(),
              HasSubstr("is in doubt: it may have been sent already"));
  EXPECT_EQ(scene.state(1), InDoubt);
}

TEST(Holding, IsRefusedByAFullDisk) {
  Scene scene;
  scene.post_to_wait();
  scene.output().full = true;
  EXPECT_FALSE(scene.reports().hold(1, scene.time()).has_value());
  EXPECT_EQ(scene.state(1), Queued);
}

TEST(Withdrawing, TellsTheClientsAndTheSameReportAgain) {
  Scene scene;
  const ClientId client = scene.post_to_wait();
  ASSERT_TRUE(scene.reports().withdraw(1, scene.time()).has_value());
  EXPECT_EQ(scene.told(client).status, 409);
  EXPECT_THAT(scene.told(client).sentence, HasSubstr("report 1 was withdrawn by the operator"));
  EXPECT_EQ(scene.told(scene.post()).status, 409);
  EXPECT_EQ(scene.send_next(), 0);
}

TEST(Sending, AWithdrawnReportLetsItGoAfterAll) {
  Scene scene;
  scene.post_to_wait();
  ASSERT_TRUE(scene.reports().withdraw(1, scene.time()).has_value());
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(Sending, OneInDoubtSendsItAtOnceAndLeavesTheOthersUndecidable) {
  Scene scene;
  scene.post(1);
  scene.lose();
  scene.hear_stop(16);
  scene.post(2);
  scene.lose();
  ASSERT_TRUE(scene.reports().send(2, scene.time()).has_value());
  EXPECT_EQ(scene.report(1).before, std::nullopt) << "if one is counted now, whose is it?";
  EXPECT_FALSE(scene.reports().is_asking(scene.report(1)));
  EXPECT_THAT(scene.report(1).note, HasSubstr("the operator decides"));
  EXPECT_EQ(scene.send_next(), 2);
}

TEST(CallingDone, SettlesADoubtAndTellsTheClientsThatItsAnswerIsNotKnown) {
  Scene scene;
  const ClientId client = scene.post();
  scene.lose();
  ASSERT_TRUE(scene.reports().settle(1, scene.time()).has_value());
  EXPECT_EQ(scene.state(1), Settled);
  EXPECT_FALSE(scene.report(1).reconciled);
  EXPECT_EQ(scene.told(client).status, 409);
  EXPECT_THAT(scene.told(client).sentence, HasSubstr("settled by the operator; its answer is not known"));
  scene.hear(19, 0);
  EXPECT_EQ(scene.told(scene.post()).status, 409) << "the same again";
}

TEST(CallingDone, DoesNotMakeTheCountOfTheNextStatusAContradiction) {
  for (const std::int64_t remaining : {19, 20}) {
    Scene scene;
    scene.post();
    scene.lose();
    ASSERT_TRUE(scene.reports().settle(1, scene.time()).has_value());
    scene.keep_hearing(5, remaining, 0);
    EXPECT_EQ(scene.reports().run().unreliable, "");
  }
}

TEST(CallingDone, LeavesTheNextDoubtToTheOperatorWhileTheFirstMayStillBeRecorded) {
  Scene scene;
  scene.post(1);
  scene.lose();
  ASSERT_TRUE(scene.reports().settle(1, scene.time()).has_value());
  scene.keep_hearing(3, 20, 0);
  scene.post(2);
  scene.lose();
  scene.keep_hearing(20, 19, 0);  // the first, late
  EXPECT_EQ(scene.state(2), InDoubt);
}

/// Of two in doubt the operator calls the second done, and the power goes at each write in turn: the first is
/// never found recorded by what the second did.
TEST(CallingDone, NeverLeavesEvidenceThatMeansSomethingElse) {
  for (std::int64_t writes = 0; writes < 4; ++writes) {
    Scene scene;
    scene.post(1);
    scene.lose();
    scene.hear_stop(16);
    scene.post(2);
    scene.lose();
    scene.output().writes_until_full = writes;
    (void)scene.reports().settle(2, scene.time());
    scene.output().writes_until_full = -1;
    scene.restart();
    for (int i = 0; i < 15; ++i) {
      scene.wait(1);
      scene.hear(19, 0, 118 + i);  // the second was recorded
    }
    EXPECT_EQ(scene.state(1), InDoubt) << writes;
  }
}

TEST(Resubmitting, MakesANewReportThatNothingHoldsBack) {
  ReportRules rules;
  rules.review = Review::All;
  Scene scene(rules);
  scene.post(1, "Drill", true);
  scene.answer(recorded());
  const auto made = scene.reports().resubmit(1, scene.time());
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(*made, 2);
  EXPECT_EQ(scene.report(2).report, scene.report(1).report);
  EXPECT_EQ(scene.report(2).sender, "operator");
  EXPECT_EQ(scene.send_next(), 2);
}

TEST(Resubmitting, IsRefusedByAFullDisk) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded());
  scene.output().full = true;
  EXPECT_FALSE(scene.reports().resubmit(1, scene.time()).has_value());
  EXPECT_EQ(scene.count(), 1);
}

TEST(TheOperator, HasToDecideWhatIsInDoubtAndNotWhatIsRefused) {
  Scene scene;
  EXPECT_THAT(scene.undecided(), ElementsAre());
  scene.post(1);
  scene.answer(answer_of(422));
  scene.post(2);
  scene.lose();
  scene.hear(17, 0);
  EXPECT_THAT(scene.undecided(), ElementsAre(scene.report(2).note));
  EXPECT_THAT(scene.reports().run().unreliable, HasSubstr("does another sender report"));
}

TEST(Resubmitting, PressedTwiceIsSentOnce) {
  Scene scene;
  scene.post();
  scene.answer(recorded());
  scene.wait(1);
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 2);
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 2);
  EXPECT_EQ(scene.send_next(), 2);
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 2) << "it is under way";
  scene.answer(recorded());
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 3) << "and that was answered";
}

/// Report 2, which is near 1.
class HeldSinceTheRunBefore : public testing::Test {
 protected:
  void SetUp() override {
    scene.post(1);
    scene.answer(recorded());
    scene.post(2);
    ASSERT_EQ(scene.state(2), Held);
    scene.reports().declare_new_run(scene.time());
    scene.hear(20, 0, 1);
  }

  static ReportRules rules() {
    ReportRules rules;
    rules.review = Review::Duplicates;
    return rules;
  }
  Scene scene{rules()};
};

TEST_F(HeldSinceTheRunBefore, IsRefusedWhereTheSameWasRecordedInThisRun) {
  scene.post(2);
  scene.answer(recorded());
  const auto sent = scene.reports().send(2, scene.time());
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error(), HasSubstr("report 3 is the same and is answered in this run"));
  EXPECT_EQ(scene.state(2), Held);
}

/// Nobody compares what was asked for with what waits.
TEST_F(HeldSinceTheRunBefore, IsRefusedWhereTheSameWaitsToBeSentInThisRun) {
  scene.post_to_wait(2);
  ASSERT_EQ(scene.state(3), Queued);
  const auto sent = scene.reports().send(2, scene.time());
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error(), HasSubstr("report 3 is the same and is queued in this run"));
  EXPECT_EQ(scene.send_next(), 3);
}

}  // namespace
}  // namespace adit::dispatch
