// A run has an address, a team and a name.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;
using testing::IsEmpty;

/// One report is recorded. Then the settings name another Command Post.
class OtherCommandPost : public testing::Test {
 protected:
  OtherCommandPost() {
    scene_.post(1);
    scene_.answer(recorded_answer(1));
    scene_.receive_status(19, 1);
  }
  void move_away() { scene_.restart(kThere); }
  void come_back() { scene_.restart(); }
  void expect_one_recording() {
    const ClientId again = scene_.post(1);
    scene_.wait(1);
    scene_.receive_status(19, 1);
    while (scene_.send_next() != 0) FAIL() << "it is resent";
    EXPECT_EQ(scene_.answer_to(again).body, recorded_answer(1).body);
  }
  Scene scene_;
};

TEST_F(OtherCommandPost, HasARunOfItsOwn) {
  move_away();
  EXPECT_EQ(scene_.reports().run().number, 2);
  EXPECT_EQ(scene_.reports().run().post, kThere);
}

TEST_F(OtherCommandPost, QueuesARepeatUntilItAnswers) {
  move_away();
  scene_.post(1);
  EXPECT_EQ(scene_.state(2), Queued);
  EXPECT_THAT(scene_.report(2).note, HasSubstr("the same as report 1"));
  EXPECT_THAT(scene_.report(2).note, HasSubstr("10.100.2.200:8000 answers"));
  scene_.reports().on_status_failed(NoStatus::Other, scene_.time());
  EXPECT_EQ(scene_.send_next(), 0) << "the run is unknown";
  scene_.receive_status(20, 0);
  EXPECT_EQ(scene_.send_next(), 2) << "in the new run";
}

TEST_F(OtherCommandPost, LeavesTheFirstRunForAReturn) {
  move_away();
  scene_.receive_status(20, 0);
  come_back();
  EXPECT_EQ(scene_.reports().run().number, 1);
  expect_one_recording();
}

TEST_F(OtherCommandPost, PassesItsReportsToTheFirstIfItNeverAnswered) {
  move_away();
  scene_.post(1);
  scene_.post(2);
  come_back();
  scene_.wait(1);
  scene_.receive_status(19, 1);
  EXPECT_EQ(scene_.send_next(), 3) << "a new report is for the first Command Post that answers";
  EXPECT_EQ(scene_.state(2), Withdrawn);
  EXPECT_EQ(scene_.report(2).same_as, 1);
  scene_.answer(recorded_answer());
  expect_one_recording();
}

/// The action was for the other Command Post.
TEST_F(OtherCommandPost, PassesOnNoActionOfTheOperator) {
  move_away();
  scene_.post(1);
  ASSERT_TRUE(scene_.reports().send(2, scene_.time()));
  come_back();
  scene_.wait(1);
  scene_.receive_status(19, 1);
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(2), Withdrawn);
}

TEST_F(OtherCommandPost, CausesNoSecondReportAtTheFirst) {
  scene_.post_queued(3);
  move_away();
  scene_.post(3);
  ASSERT_TRUE(scene_.reports().hold(3, scene_.time()));
  come_back();
  const auto sent = scene_.reports().send(3, scene_.time());
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error(), HasSubstr("report 2 is the same and is queued in this run"));
}

TEST_F(OtherCommandPost, GetsNoReportQueuedForTheFirst) {
  scene_.post_queued(3);
  move_away();
  EXPECT_EQ(scene_.state(2), Queued);
  EXPECT_EQ(scene_.report(2).run, 1);
  scene_.receive_status(20, 0);
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_THAT(scene_.reports().waiting_here(), IsEmpty());
  EXPECT_EQ(scene_.report(2).note, "kept for the Command Post at 10.100.1.200:8000");
  EXPECT_THAT(scene_.reports().waiting_elsewhere(),
              testing::ElementsAre(testing::Pair("10.100.1.200:8000", 1)));
  come_back();
  scene_.wait(1);
  scene_.receive_status(19, 1);
  EXPECT_EQ(scene_.send_next(), 2);
}

TEST_F(OtherCommandPost, HoldsReportsOfTheFirstInItsNewRun) {
  scene_.post_queued(3);
  move_away();
  come_back();
  scene_.receive_status(25, 0, 4);
  EXPECT_EQ(scene_.state(2), Held);
}

TEST_F(OtherCommandPost, DecidesNoDoubtOfTheFirst) {
  scene_.post(4);
  scene_.lose_answer();
  move_away();
  EXPECT_EQ(scene_.report(2).run, 1);
  EXPECT_THAT(scene_.report(2).note, HasSubstr("10.100.1.200:8000"));
  scene_.repeat_status(3, 18, 0);
  EXPECT_EQ(scene_.state(2), InDoubt);
  come_back();
  scene_.repeat_status(3, 18, 1);
  EXPECT_EQ(scene_.state(2), Settled);
}

TEST_F(OtherCommandPost, MakesOtherDoubtsUncertainAfterASettlement) {
  scene_.post(4);
  scene_.lose_answer();
  for (int i = 0; i < 16; ++i) {
    scene_.wait(1);
    scene_.receive_status(19, 1, 101);
  }
  scene_.post(5);
  scene_.lose_answer();
  move_away();
  ASSERT_TRUE(scene_.reports().settle(2, scene_.time()));
  EXPECT_EQ(scene_.report(3).before, std::nullopt);
}

TEST(UnheardCommandPost, KeepsItsDoubts) {
  const Time time{.now = {}, .stamp = Scene::kEpoch};
  FakeOutput output;
  Reports reports({}, output);
  reports.open({}, {}, time, "10.100.1.200:8000");
  reports.on_status_failed(NoStatus::Other, time);
  reports.accept({.report = {.type = "Drill", .position = {1, 2, 3}}, .sender = "10.0.0.7"}, 1, true, time);
  ASSERT_NE(reports.choose(time), nullptr);
  reports.on_lost("no answer", time);
  ASSERT_TRUE(output.runs.contains(1));
  Reports there({}, output);
  there.open({output.ledger.at(1)}, {output.runs.at(1)}, time, kThere);
  EXPECT_NE(there.book().at(1).run, there.run().number);
  EXPECT_EQ(there.runs().find(there.book().at(1).run)->post, "10.100.1.200:8000");
}

TEST(OtherTeam, LeavesTheFirstRunForAReturn) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer(1));
  scene.receive_status(19, 1);
  scene.wait(1);
  scene.reports().on_status({0, 5, 25, "other"}, scene.time().now, scene.time());
  EXPECT_EQ(scene.reports().run().number, 2);
  scene.wait(1);
  scene.receive_status(19, 1);
  EXPECT_EQ(scene.reports().run().number, 1);
  scene.post(1);
  EXPECT_EQ(scene.count(), 1u);
}

TEST(OtherRunName, LeavesTheFirstRunForAReturn) {
  Scene scene;
  scene.record(1, "1");
  scene.record(2, "2");
  EXPECT_EQ(scene.reports().run().number, 2);
  scene.wait(1);
  scene.receive_status(24, 0, 3);
  scene.record(3, "1");
  EXPECT_EQ(scene.reports().run().number, 1);
  scene.post(1);
  EXPECT_EQ(scene.count(), 3u);
  scene.post(2);
  EXPECT_EQ(scene.state(4), Sending) << "run 1 does not have it";
}

}  // namespace
}  // namespace adit::dispatch
