// The settings name another Command Post while a report is in flight.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

/// Report 1 is in flight and report 2 is queued when the settings change.
class PendingMove : public testing::Test {
 protected:
  PendingMove() {
    scene_.post(1);
    scene_.post(2);
    announce(kThere);
  }
  void announce(const std::string& post) { scene_.reports().prepare_move(post, scene_.time()); }
  void arrive() {
    scene_.answer(recorded_answer());
    scene_.move_to(kThere);
    scene_.wait(1);
    scene_.receive_status(20, 0);
  }
  void go_back() {
    scene_.move_to(kHere);
    scene_.wait(1);
    scene_.receive_status(19, 0);
  }
  const std::string& post_of(std::int64_t number) {
    return scene_.reports().runs().find(scene_.report(number).run)->post;
  }
  Scene scene_;
};

TEST_F(PendingMove, LeavesTheRunUntilTheAnswerArrives) {
  EXPECT_EQ(scene_.reports().run().post, kHere);
  scene_.answer(recorded_answer());
  EXPECT_EQ(scene_.state(1), Answered);
  EXPECT_EQ(post_of(1), kHere);
}

TEST_F(PendingMove, AssignsNewReportsToTheNewCommandPost) {
  const ClientId client = scene_.post(3);
  EXPECT_EQ(post_of(3), kThere);
  EXPECT_EQ(scene_.state(3), Queued);
  arrive();
  EXPECT_EQ(scene_.send_next(), 3);
  scene_.answer(recorded_answer(1));
  EXPECT_EQ(scene_.answer_to(client).status, 201);
  EXPECT_EQ(scene_.send_next(), 0) << "report 2 is kept";
  EXPECT_EQ(post_of(2), kHere);
}

TEST_F(PendingMove, SurvivesARestart) {
  scene_.post(3);
  scene_.restart(kThere);
  EXPECT_EQ(scene_.reports().run().post, kThere);
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_EQ(post_of(1), kHere);
  scene_.receive_status(20, 0);
  EXPECT_EQ(scene_.send_next(), 3);
}

TEST_F(PendingMove, GivesARepeatTheAnswerInFlight) {
  const ClientId again = scene_.post(1);
  scene_.answer(recorded_answer(1));
  EXPECT_EQ(scene_.count(), 2u);
  EXPECT_EQ(scene_.answer_to(again).body, recorded_answer(1).body);
}

TEST_F(PendingMove, SendsARepeatOfAQueuedReportToBoth) {
  scene_.post(2);
  arrive();
  EXPECT_EQ(scene_.send_next(), 3);
  scene_.answer(recorded_answer());
  go_back();
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(PendingMove, CanBeRevertedWithItsNewReports) {
  scene_.post(3);
  announce(kHere);
  EXPECT_EQ(post_of(3), kHere) << "the other Command Post never answered";
  scene_.answer(recorded_answer());
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(PendingMove, KeepsNewReportsForAKnownCommandPost) {
  arrive();
  go_back();
  ASSERT_EQ(scene_.send_next(), 2);
  announce(kThere);
  scene_.post(3);
  announce(kHere);
  EXPECT_EQ(post_of(3), kThere);
}

TEST_F(PendingMove, AppliesActionsToTheNewCommandPost) {
  ASSERT_TRUE(scene_.reports().send(2, scene_.time()));
  EXPECT_EQ(post_of(2), kThere);
  const std::int64_t run = scene_.reports().declare_new_run(scene_.time());
  arrive();
  EXPECT_EQ(scene_.reports().run().number, run);
}

TEST_F(PendingMove, HoldsADoubtThatTheOperatorSentToACommandPostWithoutAnswer) {
  scene_.lose_answer();
  scene_.move_to(kThere);
  ASSERT_TRUE(scene_.reports().send(1, scene_.time()));
  EXPECT_EQ(post_of(1), kThere);
  go_back();
  EXPECT_EQ(post_of(1), kHere);
  EXPECT_EQ(scene_.state(1), Held) << "it may be recorded here";
  EXPECT_THAT(scene_.report(1).note, HasSubstr("did not answer"));
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(PendingMove, CountsReportsQueuedForTheOldCommandPost) {
  EXPECT_THAT(scene_.reports().waiting_elsewhere(), ElementsAre(testing::Pair("10.100.1.200:8000", 1)));
}

}  // namespace
}  // namespace adit::dispatch
