// Actions of the operator.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

/// The states in which an action is accepted.
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

class OperatorsActions : public testing::TestWithParam<Words> {
 protected:
  /// True if `say` moved a report that is in that state. A rejected action changes nothing.
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
      EXPECT_THAT(outcome.error(), HasSubstr("report 1 is " + std::string(display_name(GetParam().state))));
    }
    return outcome.has_value();
  }
};

TEST_P(OperatorsActions, FollowTheTable) {
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.send(1, time); }), GetParam().send);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.hold(1, time); }), GetParam().hold);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.withdraw(1, time); }), GetParam().withdraw);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.settle(1, time); }), GetParam().done);
  EXPECT_EQ(taken([](Reports& all, Time time) { return all.resubmit(1, time); }), GetParam().resubmit);
}
INSTANTIATE_TEST_SUITE_P(States, OperatorsActions, testing::ValuesIn(kWords));

TEST(Operator, LearnsThatAReportDoesNotExist) {
  Scene scene;
  const std::string none = "there is no report 7";
  EXPECT_EQ(scene.reports().send(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().hold(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().withdraw(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().settle(7, scene.time()).error(), none);
  EXPECT_EQ(scene.reports().resubmit(7, scene.time()).error(), none);
}

TEST(HoldAction, LastsUntilTheOperatorSendsTheReport) {
  Scene scene;
  const ClientId client = scene.post_queued();
  ASSERT_TRUE(scene.reports().hold(1, scene.time()).has_value());
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_EQ(scene.report(1).note, "the operator held it");
  EXPECT_EQ(scene.answer_to(client).status, 503);
  EXPECT_THAT(scene.answer_to(client).sentence, HasSubstr("is held until the operator decides"));
  EXPECT_THAT(scene.undecided(), ElementsAre("the operator held it"));
  scene.repeat_status(60, 20, 0);
  EXPECT_EQ(scene.send_next(), 0);
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(HoldAction, ExplainsWhyItIsTooLate) {
  Scene scene;
  scene.post(1);
  EXPECT_THAT(scene.reports().hold(1, scene.time()).error(),
              HasSubstr("is sending: it may have been sent already"));
  scene.lose_answer();
  EXPECT_THAT(scene.reports().hold(1, scene.time()).error(),
              HasSubstr("is in doubt: it may have been sent already"));
  EXPECT_EQ(scene.state(1), InDoubt);
}

TEST(WithdrawAction, AnswersClientsAndRepeats) {
  Scene scene;
  const ClientId client = scene.post_queued();
  ASSERT_TRUE(scene.reports().withdraw(1, scene.time()).has_value());
  EXPECT_EQ(scene.answer_to(client).status, 409);
  EXPECT_THAT(scene.answer_to(client).sentence, HasSubstr("report 1 was withdrawn by the operator"));
  EXPECT_EQ(scene.answer_to(scene.post()).status, 409);
  EXPECT_EQ(scene.send_next(), 0);
}

TEST(SendAction, LeavesOtherDoubtsToTheOperator) {
  Scene scene;
  scene.post(1);
  scene.lose_answer();
  scene.repeat_stop(16);
  scene.post(2);
  scene.lose_answer();
  ASSERT_TRUE(scene.reports().send(2, scene.time()).has_value());
  EXPECT_EQ(scene.report(1).before, std::nullopt) << "either may be counted now";
  EXPECT_FALSE(scene.reports().is_asking(scene.report(1)));
  EXPECT_THAT(scene.report(1).note, HasSubstr("the operator decides"));
  EXPECT_EQ(scene.send_next(), 2);
}

TEST(SettleAction, TellsClientsThatTheAnswerIsUnknown) {
  Scene scene;
  const ClientId client = scene.post();
  scene.lose_answer();
  ASSERT_TRUE(scene.reports().settle(1, scene.time()).has_value());
  EXPECT_EQ(scene.state(1), Settled);
  EXPECT_FALSE(scene.report(1).reconciled);
  EXPECT_EQ(scene.answer_to(client).status, 409);
  EXPECT_THAT(scene.answer_to(client).sentence,
              HasSubstr("settled by the operator; its answer is not known"));
  scene.receive_status(19, 0);
  EXPECT_EQ(scene.answer_to(scene.post()).status, 409) << "a repeat";
}

TEST(SettleAction, AllowsEitherCountInTheNextStatus) {
  for (const std::int64_t remaining : {19, 20}) {
    Scene scene;
    scene.post();
    scene.lose_answer();
    ASSERT_TRUE(scene.reports().settle(1, scene.time()).has_value());
    scene.repeat_status(5, remaining, 0);
    EXPECT_EQ(scene.reports().run().unreliable, "");
  }
}

TEST(SettleAction, LeavesTheNextDoubtToTheOperator) {
  Scene scene;
  scene.post(1);
  scene.lose_answer();
  ASSERT_TRUE(scene.reports().settle(1, scene.time()).has_value());
  scene.repeat_status(3, 20, 0);
  scene.post(2);
  scene.lose_answer();
  scene.repeat_status(20, 19, 0);  // report 1 is recorded late
  EXPECT_EQ(scene.state(2), InDoubt);
}

/// The operator settles the second of two doubts, and the power fails at each write: the count of the second
/// report never settles the first.
TEST(SettleAction, LeavesNoFalseEvidenceAtAPowerCut) {
  for (std::int64_t writes = 0; writes < 4; ++writes) {
    Scene scene;
    scene.post(1);
    scene.lose_answer();
    scene.repeat_stop(16);
    scene.post(2);
    scene.lose_answer();
    scene.output().writes_until_full = writes;
    (void)scene.reports().settle(2, scene.time());
    scene.output().writes_until_full = -1;
    scene.restart();
    for (int i = 0; i < 15; ++i) {
      scene.wait(1);
      scene.receive_status(19, 0, 118 + i);  // report 2 was recorded
    }
    EXPECT_EQ(scene.state(1), InDoubt) << writes;
  }
}

TEST(SendAction, IsRejectedForADoubtIfTheSameReportWasAnsweredLater) {
  Scene scene;
  scene.post(1);
  scene.lose_answer();
  scene.repeat_stop(16);
  scene.post(1, "Drill", true);
  scene.answer(recorded_answer());
  ASSERT_EQ(scene.state(1), InDoubt);
  const auto sent = scene.reports().send(1, scene.time());
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error(), HasSubstr("report 2 is the same"));
  EXPECT_EQ(scene.state(1), InDoubt);
}

TEST(SendAction, IsAcceptedForADoubtThatRepeatsARecordedReportOnPurpose) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer());
  scene.post(1, "Drill", true);
  scene.lose_answer();
  ASSERT_EQ(scene.state(2), InDoubt);
  EXPECT_TRUE(scene.reports().send(2, scene.time()));
}

TEST(ResubmitAction, MakesANewReportThatNoReviewHolds) {
  ReportRules rules;
  rules.review = Review::All;
  Scene scene(rules);
  scene.post(1, "Drill", true);
  scene.answer(recorded_answer());
  const auto made = scene.reports().resubmit(1, scene.time());
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(*made, 2);
  EXPECT_EQ(scene.report(2).report, scene.report(1).report);
  EXPECT_EQ(scene.report(2).sender, "operator");
  EXPECT_EQ(scene.send_next(), 2);
}

TEST(Operator, DecidesDoubtsButNoRejectedReports) {
  Scene scene;
  EXPECT_THAT(scene.undecided(), ElementsAre());
  scene.post(1);
  scene.answer(answer_of(422));
  scene.post(2);
  scene.lose_answer();
  scene.receive_status(17, 0);
  EXPECT_THAT(scene.undecided(), ElementsAre(scene.report(2).note));
  EXPECT_THAT(scene.reports().run().unreliable, HasSubstr("another sender may report"));
}

TEST(ResubmitAction, SendsOnceIfPressedTwice) {
  Scene scene;
  scene.post();
  scene.answer(recorded_answer());
  scene.wait(1);
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 2);
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 2);
  EXPECT_EQ(scene.send_next(), 2);
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 2) << "in flight";
  scene.answer(recorded_answer());
  scene.output().full = true;
  EXPECT_FALSE(scene.reports().resubmit(1, scene.time()));
  scene.output().full = false;
  EXPECT_EQ(scene.reports().resubmit(1, scene.time()), 3) << "answered";
}

/// Report 2 is near report 1.
class ReportHeldInTheLastRun : public testing::Test {
 protected:
  void SetUp() override {
    scene.post(1);
    scene.answer(recorded_answer());
    scene.post(2);
    ASSERT_EQ(scene.state(2), Held);
    scene.reports().declare_new_run(scene.time());
    scene.receive_status(20, 0, 1);
  }

  static ReportRules rules() {
    ReportRules rules;
    rules.review = Review::Duplicates;
    return rules;
  }
  Scene scene{rules()};
};

TEST_F(ReportHeldInTheLastRun, CannotBeSentIfARepeatIsAnswered) {
  scene.post(2);
  scene.answer(recorded_answer());
  const auto sent = scene.reports().send(2, scene.time());
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error(), HasSubstr("report 3 is the same and is answered in this run"));
  EXPECT_EQ(scene.state(2), Held);
}

TEST_F(ReportHeldInTheLastRun, CannotBeSentIfARepeatIsQueued) {
  scene.post_queued(2);
  ASSERT_EQ(scene.state(3), Queued);
  const auto sent = scene.reports().send(2, scene.time());
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error(), HasSubstr("report 3 is the same and is queued in this run"));
  EXPECT_EQ(scene.send_next(), 3);
}

}  // namespace
}  // namespace adit::dispatch
