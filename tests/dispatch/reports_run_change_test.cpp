// Reports that were answered between the last status of one run and the first of the next.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;

/// A status shows a new run, and a report was answered just before. The answer is the first with a run's
/// name, so its run is unknown.
class AnswerAtARunChange : public testing::Test {
 protected:
  AnswerAtARunChange() {
    scene_.wait(5);
    scene_.record(1, "1");
    scene_.wait(5);
    scene_.receive_status(25, 0, 3);
  }
  Scene scene_;
};

TEST_F(AnswerAtARunChange, HoldsARepeat) {
  ASSERT_EQ(scene_.reports().run().number, 2);
  const ClientId again = scene_.post(1);
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_EQ(scene_.report(2).same_as, 1);
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the same as report 1"));
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the reports left went up from 20 to 25"));
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 2u) << "it joins the held one";
  scene_.wait(21);
  EXPECT_THAT(scene_.answer_to(again).sentence, HasSubstr("is held until the operator decides"));
}

/// Either both answers are of the new run, or all runs have one name.
TEST_F(AnswerAtARunChange, IsTheOperatorsIfBothRunsHaveItsName) {
  scene_.post(1);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.reports().run().number, 2);
  EXPECT_EQ(scene_.state(2), Held);
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 3u) << "it joins the held one";
}

TEST_F(AnswerAtARunChange, BelongsToTheOldRunIfTheNewNameDiffers) {
  scene_.post(1);
  scene_.record(2, "2");
  EXPECT_EQ(scene_.reports().run().number, 2);
  EXPECT_EQ(scene_.report(1).run, 1);
  EXPECT_EQ(scene_.output().ledger.at(1).run, 1);
  EXPECT_EQ(scene_.send_next(), 2) << "the new run does not have it";
  EXPECT_EQ(scene_.report(2).same_as, 0);
}

TEST_F(AnswerAtARunChange, HoldsNoRepeatOnceItsRunIsKnown) {
  scene_.record(2, "2");
  scene_.post(1);
  EXPECT_EQ(scene_.state(3), Sending);
}

TEST_F(AnswerAtARunChange, LetsTheOperatorSendTheRepeat) {
  scene_.post(1);
  ASSERT_TRUE(scene_.reports().send(2, scene_.time()));
  EXPECT_EQ(scene_.send_next(), 2);
  scene_.answer(recorded_answer(0, "scored", "2"));
  EXPECT_EQ(scene_.state(2), Answered);
  EXPECT_EQ(scene_.report(1).run, 1);
}

TEST_F(AnswerAtARunChange, HoldsARepeatAfterARestart) {
  scene_.restart();
  scene_.receive_status(25, 0, 4);
  scene_.post(1);
  EXPECT_EQ(scene_.state(2), Held);
  scene_.record(2, "1");
  EXPECT_EQ(scene_.state(2), Held);
}

TEST_F(AnswerAtARunChange, HoldsARepeatIfNoAnswerNamesARun) {
  scene_.post(1);
  scene_.record(2, "");
  EXPECT_EQ(scene_.state(2), Held);
  EXPECT_THAT(scene_.undecided(), testing::Contains(HasSubstr("the same as report 1")));
}

TEST(AnswerBeforeARestart, HoldsARepeatInALikelyNewRun) {
  Scene scene;
  scene.wait(5);
  scene.post(1);
  scene.answer(recorded_answer(0, "scored", "1", 105));
  scene.restart();
  scene.wait(5);
  scene.receive_status(25, 0, 3);
  ASSERT_EQ(scene.reports().run().number, 2);
  scene.post(1);
  EXPECT_EQ(scene.state(2), Held);
}

TEST(AnswerBeforeAStatus, BelongsToTheOldRun) {
  Scene scene;
  scene.wait(5);
  scene.post(1);
  scene.answer(recorded_answer());
  scene.wait(5);
  scene.receive_status(19, 0);
  scene.wait(5);
  scene.receive_status(25, 0, 3);
  EXPECT_EQ(scene.report(1).run, 1);
  scene.post(1);
  EXPECT_EQ(scene.state(2), Held) << "its run may go on";
  scene.record(2, "2");
  EXPECT_EQ(scene.send_next(), 2);
}

TEST(UnnamedAnswerAtARunChange, BelongsToTheNewRunWhateverItsName) {
  Scene scene;
  scene.wait(5);
  scene.record(1, "");
  scene.wait(5);
  scene.receive_status(25, 0, 3);
  const ClientId again = scene.post(1);
  ASSERT_EQ(scene.state(2), Held);
  scene.record(2, "2");
  EXPECT_EQ(scene.report(1).run, 2);
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_EQ(scene.state(2), Withdrawn);
  EXPECT_EQ(scene.answer_to(again).status, 201);
}

}  // namespace
}  // namespace adit::dispatch
