// The operator corrects held reports.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

icd::ArtifactReport drill(double x) {
  return {.type = "Drill", .position = {x, 0, 0}};
}

class Correction : public testing::Test {
 protected:
  /// Report 1, at 1 m, is held.
  Correction() {
    client_ = scene_.post_queued(1);
    EXPECT_TRUE(scene_.reports().hold(1, scene_.time()));
  }
  Reports::Outcome correct(std::int64_t number, double x) {
    return scene_.reports().correct(number, drill(x), scene_.time());
  }
  void send(std::int64_t number, const HttpAnswer& answer) {
    ASSERT_EQ(scene_.send_next(), number);
    scene_.answer(answer);
  }

  Scene scene_;
  ClientId client_ = 0;
};

TEST_F(Correction, IsSentInsteadOfTheReport) {
  const std::int64_t before = scene_.output().writes;
  ASSERT_EQ(correct(1, 5), 2);
  EXPECT_EQ(scene_.output().writes, before + 1);
  EXPECT_EQ(scene_.state(1), Withdrawn);
  EXPECT_EQ(scene_.report(1).report.position.x, 1) << "unchanged";
  EXPECT_EQ(scene_.report(1).note, "the operator corrected it: report 2, \"Drill\" at 5, 0, 0");
  EXPECT_EQ(scene_.report(2).note, "corrects report 1, \"Drill\" at 1, 0, 0");
  send(2, recorded_answer());
  scene_.repeat_status(60, 19, 0);
  EXPECT_EQ(scene_.send_next(), 0);
}

TEST_F(Correction, NamesPlacesToTheMillimetre) {
  ASSERT_EQ(correct(1, 32.649296743559084), 2);
  EXPECT_EQ(scene_.report(1).note, "the operator corrected it: report 2, \"Drill\" at 32.649, 0, 0");
}

TEST_F(Correction, KeepsTheRobot) {
  scene_.post({.report = {.type = "Drill", .position = {9, 0, 0}, .robot = icd::RobotName::parse("spot1")},
               .sender = "10.0.0.7"},
              false);
  ASSERT_TRUE(scene_.reports().hold(2, scene_.time()));
  ASSERT_EQ(correct(2, 5), 3);
  EXPECT_EQ(scene_.report(3).report.robot, icd::RobotName::parse("spot1"));
}

TEST_F(Correction, ChangesNothingIfTheDiskIsFull) {
  const Report before = scene_.report(1);
  scene_.output().full = true;
  EXPECT_FALSE(correct(1, 5));
  EXPECT_EQ(scene_.report(1), before);
  EXPECT_EQ(scene_.count(), 1);
}

TEST_F(Correction, AnswersRepeatsOfTheOldReport) {
  ASSERT_TRUE(correct(1, 5));
  const ClientId early = scene_.post(1);
  send(2, recorded_answer(1));
  const ClientId late = scene_.post(1);
  EXPECT_EQ(scene_.answer_to(early).status, 201);
  EXPECT_EQ(scene_.answer_to(late).body, scene_.report(2).answer);
  EXPECT_EQ(scene_.count(), 2);
}

TEST_F(Correction, AnswersTheWaitingClient) {
  Scene scene({.review = Review::All, .policy = {}});
  const ClientId client = scene.post(1);
  ASSERT_EQ(scene.reports().correct(1, drill(5), scene.time()), 2);
  ASSERT_EQ(scene.send_next(), 2) << "no second review";
  scene.answer(recorded_answer(1));
  EXPECT_EQ(scene.answer_to(client).status, 201);
}

TEST_F(Correction, SurvivesARestart) {
  ASSERT_TRUE(correct(1, 5));
  scene_.restart();
  scene_.receive_status(20, 0);
  const ClientId again = scene_.post(1);
  send(2, recorded_answer(1));
  EXPECT_EQ(scene_.answer_to(again).status, 201);
  scene_.restart();
  scene_.receive_status(19, 1);
  EXPECT_EQ(scene_.answer_to(scene_.post(1)).number, 2);
  EXPECT_EQ(scene_.send_next(), 0);
}

TEST_F(Correction, CanBeCorrected) {
  ASSERT_TRUE(correct(1, 5));
  ASSERT_TRUE(scene_.reports().hold(2, scene_.time()));
  ASSERT_EQ(correct(2, 6), 3);
  send(3, recorded_answer(1));
  EXPECT_EQ(scene_.answer_to(scene_.post(1)).number, 3);
  EXPECT_EQ(scene_.answer_to(scene_.post(5)).number, 3);
}

TEST_F(Correction, HoldsARepeatIfItWasRejected) {
  ASSERT_TRUE(correct(1, 5));
  send(2, answer_of(422));
  scene_.post(1);
  EXPECT_EQ(scene_.state(3), Held);
  EXPECT_EQ(scene_.report(3).note, "the same as report 1, corrected as report 2");
}

TEST_F(Correction, TellsARepeatThatItWasWithdrawn) {
  ASSERT_TRUE(correct(1, 5));
  ASSERT_TRUE(scene_.reports().withdraw(2, scene_.time()));
  EXPECT_THAT(scene_.answer_to(scene_.post(1)).sentence, HasSubstr("report 2 was withdrawn"));
  EXPECT_EQ(scene_.count(), 2);
}

TEST_F(Correction, RequiresAHeldReport) {
  ASSERT_TRUE(correct(1, 5));
  EXPECT_EQ(correct(1, 6).error(), "report 1 is withdrawn: only a held report can be corrected");
  EXPECT_EQ(correct(2, 6).error(), "report 2 is queued: only a held report can be corrected");
  ASSERT_EQ(scene_.send_next(), 2);
  EXPECT_EQ(correct(2, 6).error(), "report 2 is sending: only a held report can be corrected");
  scene_.lose_answer();
  EXPECT_EQ(correct(2, 6).error(), "report 2 is in doubt: only a held report can be corrected");
  EXPECT_EQ(correct(7, 6).error(), "there is no report 7");
}

TEST_F(Correction, IsRejectedIfItChangesNothing) {
  EXPECT_THAT(correct(1, 1.0005).error(), HasSubstr("the correction is the same report"));
  EXPECT_EQ(scene_.state(1), Held);
}

TEST_F(Correction, IsRejectedIfTheSameReportExists) {
  scene_.post_queued(5);
  EXPECT_EQ(correct(1, 5).error(),
            "report 1 is held: report 2 is the same as the correction and is queued in this run");
  send(2, recorded_answer());
  EXPECT_THAT(correct(1, 5).error(), HasSubstr("is answered in this run"));
  EXPECT_EQ(scene_.state(1), Held);
}

TEST_F(Correction, MovesAReportOfAnEarlierRunIntoThisOne) {
  scene_.wait(20);
  scene_.reports().declare_new_run(scene_.time());
  scene_.receive_status(20, 0);
  ASSERT_TRUE(correct(1, 5));
  send(2, recorded_answer(1));
  EXPECT_EQ(scene_.answer_to(scene_.post(1)).number, 2);
}

TEST_F(Correction, CanBeUndone) {
  Scene scene({.review = Review::All, .policy = {}, .undo = std::chrono::seconds(10)});
  scene.post(1);
  ASSERT_EQ(scene.reports().correct(1, drill(5), scene.time()), 2);
  EXPECT_TRUE(scene.reports().sends_at(scene.report(2)).has_value());
  EXPECT_THAT(scene.output().states[2], ElementsAre(Queued, Held));
  scene.wait(10);
  EXPECT_EQ(scene.send_next(), 2);
}

}  // namespace
}  // namespace adit::dispatch
