// Reports of the operator that can be undone.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

ReportRules with_undo(Review review = Review::Off) {
  return {.review = review, .policy = {}, .undo = std::chrono::seconds(10)};
}

class Undo : public testing::Test {
 protected:
  Scene scene_{with_undo()};
  bool is_to_be_sent(std::int64_t number) const {
    return scene_.reports().sends_at(scene_.report(number)).has_value();
  }
};

TEST_F(Undo, StoresTheReportAtOnceAndSendsItLater) {
  scene_.compose();
  EXPECT_EQ(scene_.output().ledger.at(1).state, Held);
  EXPECT_EQ(scene_.reports().sends_at(scene_.report(1)), scene_.time().stamp + 10);
  EXPECT_EQ(scene_.reports().next_deadline(), scene_.time().now + std::chrono::seconds(10));
  scene_.wait(9.9);
  EXPECT_EQ(scene_.send_next(), 0);
  scene_.wait(0.1);
  EXPECT_FALSE(is_to_be_sent(1));
  EXPECT_EQ(scene_.send_next(), 1);
}

TEST_F(Undo, DelaysOnlyTheOperatorsReports) {
  scene_.post();
  EXPECT_EQ(scene_.state(1), Sending);
}

TEST_F(Undo, IsOffByDefault) {
  Scene scene;
  scene.compose();
  EXPECT_EQ(scene.state(1), Sending);
}

TEST_F(Undo, NeverSendsAReportThatTheOperatorUndid) {
  scene_.compose();
  scene_.wait(9);
  ASSERT_TRUE(scene_.reports().withdraw(1, scene_.time()));
  EXPECT_EQ(scene_.report(1).note, "the operator undid it");
  scene_.repeat_status(60, 20, 0);
  scene_.restart();
  scene_.repeat_status(60, 20, 0);
  EXPECT_EQ(scene_.state(1), Withdrawn);
  EXPECT_THAT(scene_.output().states[1], ElementsAre(Queued, Held, Withdrawn));
}

TEST_F(Undo, IsPossibleUntilTheSendingBegins) {
  scene_.post(1);
  scene_.compose(2);
  scene_.wait(10);
  EXPECT_EQ(scene_.state(2), Queued) << "another report is in flight";
  EXPECT_TRUE(scene_.reports().withdraw(2, scene_.time()));
}

TEST_F(Undo, IsRejectedOnceTheSendingHasBegun) {
  scene_.compose();
  scene_.wait(10);
  ASSERT_EQ(scene_.send_next(), 1);
  EXPECT_EQ(scene_.reports().withdraw(1, scene_.time()).error(),
            "report 1 is sending: its sending has begun, so it cannot be undone");
  scene_.answer(recorded_answer());
  EXPECT_EQ(scene_.state(1), Answered);
}

TEST_F(Undo, EndsAtOnceIfTheOperatorSendsTheReport) {
  scene_.compose();
  ASSERT_TRUE(scene_.reports().send(1, scene_.time()));
  EXPECT_FALSE(is_to_be_sent(1));
  EXPECT_EQ(scene_.report(1).note, "the operator sent it");
  EXPECT_EQ(scene_.send_next(), 1);
  EXPECT_FALSE(scene_.report(1).asked) << "a repeat is detected as usual";
}

TEST_F(Undo, EndsIfTheOperatorHoldsTheReport) {
  scene_.compose();
  ASSERT_TRUE(scene_.reports().hold(1, scene_.time()));
  EXPECT_EQ(scene_.report(1).note, "the operator held it");
  scene_.repeat_status(60, 20, 0);
  EXPECT_EQ(scene_.state(1), Held);
  EXPECT_FALSE(scene_.reports().hold(1, scene_.time()));
}

TEST_F(Undo, LeavesTheReportHeldAfterARestart) {
  scene_.compose();
  scene_.restart();
  EXPECT_FALSE(is_to_be_sent(1));
  scene_.repeat_status(60, 20, 0);
  EXPECT_EQ(scene_.state(1), Held);
  EXPECT_EQ(scene_.reports().next_deadline(), std::nullopt);
  ASSERT_TRUE(scene_.reports().send(1, scene_.time()));
  EXPECT_EQ(scene_.send_next(), 1);
}

TEST_F(Undo, QueuesNoReportWhileAditdStops) {
  scene_.compose();
  scene_.reports().dismiss(false);
  EXPECT_EQ(scene_.reports().next_deadline(), std::nullopt);
  scene_.wait(10);
  EXPECT_EQ(scene_.output().ledger.at(1).state, Held);
}

TEST_F(Undo, LeavesTheReportHeldInANewRun) {
  scene_.compose();
  scene_.wait(1);
  scene_.reports().declare_new_run(scene_.time());
  EXPECT_EQ(scene_.report(1).note, "a new run began (the operator declared it)");
  EXPECT_FALSE(is_to_be_sent(1));
  scene_.repeat_status(60, 20, 0);
  EXPECT_EQ(scene_.state(1), Held);
}

TEST_F(Undo, LeavesTheReportHeldIfANewRunOnlySeemedToBegin) {
  scene_.record(1, "1");
  scene_.wait(1);
  scene_.receive_status(19, 0);
  scene_.compose(10);
  const double clock = scene_.run_clock();
  scene_.wait(1);
  scene_.receive_status(20, 0, clock);  // the count rose while the clock stood
  ASSERT_EQ(scene_.reports().run().number, 2);
  scene_.record(30, "1");
  ASSERT_EQ(scene_.reports().run().number, 1);
  EXPECT_EQ(scene_.send_next(), 0);
  scene_.repeat_status(60, 19, 0);
  EXPECT_EQ(scene_.state(2), Held);
}

TEST_F(Undo, LeavesTheReportHeldAtAnotherCommandPost) {
  scene_.compose();
  scene_.move_to(kThere);
  scene_.repeat_status(60, 20, 0);
  EXPECT_EQ(scene_.state(1), Held);
}

TEST_F(Undo, LeavesAReviewedReportHeld) {
  Scene scene(with_undo(Review::All));
  scene.compose();
  EXPECT_EQ(scene.report(1).note, "every report is reviewed");
  scene.repeat_status(60, 20, 0);
  EXPECT_EQ(scene.state(1), Held);
}

TEST_F(Undo, ComparesTheReportAtItsEnd) {
  Scene scene(with_undo(Review::Duplicates));
  scene.post(1);
  scene.compose(10);
  scene.answer(recorded_answer());
  scene.post(10.5);
  EXPECT_EQ(scene.state(3), Held) << "near report 2, which can still be undone";
  ASSERT_TRUE(scene.reports().send(3, scene.time()));
  ASSERT_EQ(scene.send_next(), 3);
  scene.answer(recorded_answer());
  scene.wait(10);
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_THAT(scene.report(2).note, HasSubstr("the same type as report 3"));
}

TEST_F(Undo, GivesARepeatOfAClientTheAnswer) {
  scene_.compose();
  const ClientId client = scene_.post();
  EXPECT_EQ(scene_.count(), 1);
  scene_.wait(10);
  ASSERT_EQ(scene_.send_next(), 1);
  scene_.answer(recorded_answer(1));
  EXPECT_EQ(scene_.answer_to(client).status, 201);
}

TEST_F(Undo, BlocksTheSameReport) {
  scene_.compose();
  ASSERT_TRUE(scene_.reports().withdraw(1, scene_.time()));
  scene_.compose(1, true);
  EXPECT_TRUE(is_to_be_sent(2));
  EXPECT_THAT(scene_.reports().send(1, scene_.time()).error(), HasSubstr("report 2 is the same and is held"));
}

TEST_F(Undo, RetriesItsEndIfTheDiskIsFull) {
  scene_.compose();
  scene_.output().full = true;
  scene_.wait(10);
  EXPECT_EQ(scene_.state(1), Held);
  EXPECT_GT(scene_.reports().next_deadline(), scene_.time().now);
  scene_.output().full = false;
  scene_.wait(1);
  EXPECT_EQ(scene_.send_next(), 1);
}

TEST_F(Undo, NeedsNoStatus) {
  scene_.compose();
  scene_.wait(30);
  scene_.reports().on_status_failed(NoStatus::Other, scene_.time());
  EXPECT_EQ(scene_.send_next(), 1);
}

}  // namespace
}  // namespace adit::dispatch
