// A posted report is accepted, joined to an earlier one, held or rejected.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

ReportRules reviewing(Review review) {
  ReportRules rules;
  rules.review = review;
  return rules;
}

TEST(NewReport, IsSentAfterOneWriteOfBothSteps) {
  Scene scene;
  const auto writes = scene.output().writes;
  scene.post();
  EXPECT_EQ(scene.output().writes, writes + 1);
  EXPECT_THAT(scene.output().states[1], ElementsAre(Queued, Sending));
  ASSERT_NE(scene.reports().sending(), nullptr);
  EXPECT_EQ(scene.reports().sending()->before->remaining_reports, 20) << "kept for a doubt";
}

TEST(NewReport, KeepsItsPlaceInTheOrder) {
  Scene scene;
  for (const double x : {1, 2, 3}) scene.post_queued(x);
  const ClientId late = scene.post(4);
  EXPECT_EQ(scene.reports().sending(), nullptr) << "it does not overtake";
  for (const std::int64_t number : {1, 2, 3, 4}) {
    EXPECT_EQ(scene.send_next(), number);
    EXPECT_FALSE(scene.is_answered(late));
    scene.answer(recorded_answer());
  }
  EXPECT_EQ(scene.answer_to(late).status, 201);
}

TEST(NewReport, IsQueuedUntilTheRunIsKnown) {
  Scene scene;
  scene.wait(16);
  scene.post();
  EXPECT_EQ(scene.reports().sending(), nullptr);
  EXPECT_FALSE(scene.reports().next_requests(scene.time()).report);
  EXPECT_EQ(scene.reports().next_requests(scene.time()).status, scene.time().now);
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(NewReport, IsRejectedByAFullQueue) {
  ReportRules rules;
  rules.most_waiting = 2;
  Scene scene(rules);
  scene.post_queued(1);
  scene.post_queued(2);
  const auto told = scene.answer_to(scene.post_queued(3));
  EXPECT_EQ(told.status, 429);
  EXPECT_THAT(told.sentence, HasSubstr("not accepted"));
  EXPECT_EQ(told.number, 0);
  EXPECT_EQ(scene.count(), 2);
  const ClientId joined = scene.post_queued(2);
  EXPECT_FALSE(scene.is_answered(joined)) << "a repeat needs no room";
}

TEST(RepeatedReport, JoinsAReportInFlight) {
  Scene scene;
  const ClientId first = scene.post(1);
  const ClientId second = scene.post(1, "dRILL");
  EXPECT_EQ(scene.count(), 1);
  scene.answer(recorded_answer(1));
  for (const ClientId client : {first, second}) {
    EXPECT_EQ(scene.answer_to(client).status, 201);
    EXPECT_EQ(scene.answer_to(client).body, recorded_answer(1).body);
    EXPECT_EQ(scene.output().answers[client].size(), 1);
  }
}

TEST(RepeatedReport, GetsTheStoredAnswerByteForByte) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer(1));
  scene.wait(5);
  const auto told = scene.answer_to(scene.post(1));
  EXPECT_EQ(told.status, 201);
  EXPECT_EQ(told.body, recorded_answer(1).body);
  EXPECT_EQ(told.number, 1);
  EXPECT_EQ(scene.count(), 1);
}

TEST(RepeatedReport, IsSentIfTheFirstWasRejected) {
  Scene scene;
  scene.post(1);
  scene.answer(answer_of(422));
  scene.post(1);
  EXPECT_EQ(scene.state(2), Sending);
}

TEST(RepeatedReport, IsSentIfTheFirstWasNotScored) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer(0, "admin stop"));
  scene.post(1);
  EXPECT_EQ(scene.state(2), Sending);
}

TEST(RepeatedReport, IsNotSentIfTheRunAcceptsNoMore) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer(0, "time limit exceeded"));
  EXPECT_EQ(scene.answer_to(scene.post(1)).body, scene.report(1).answer);
  EXPECT_EQ(scene.count(), 1);
}

TEST(RepeatedReport, IsComparedOnceTheRunIsKnown) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer());
  scene.wait(16);
  const ClientId client = scene.post(1);
  EXPECT_FALSE(scene.is_answered(client)) << "it may be meant for another run";
  EXPECT_EQ(scene.state(2), Queued);
  scene.receive_status(19, 0);
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_EQ(scene.state(2), Withdrawn);
  EXPECT_EQ(scene.report(2).same_as, 1);
  EXPECT_EQ(scene.answer_to(client).body, recorded_answer().body);
}

/// If the first report is rejected or unscored, its joined repeat blocks no later one.
TEST(RepeatedReport, IsSentThoughAnEarlierRepeatWasJoined) {
  for (const HttpAnswer& outcome : {answer_of(422), recorded_answer(0, "admin stop")}) {
    Scene scene;
    scene.post_queued(1);
    ASSERT_TRUE(scene.reports().withdraw(1, scene.time()).has_value());
    scene.wait(16);
    const ClientId repeat = scene.post(1);
    scene.receive_status(20, 0);
    scene.send_next();
    ASSERT_EQ(scene.report(2).same_as, 1);
    EXPECT_EQ(scene.answer_to(repeat).status, 409);
    ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
    ASSERT_EQ(scene.send_next(), 1);
    scene.answer(outcome);
    scene.post(1);
    ASSERT_EQ(scene.count(), 3);
    EXPECT_EQ(scene.state(3), Sending);
  }
}

TEST(ResubmittedReport, IsSentAsANewReport) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer());
  scene.post(1, "Drill", true);
  ASSERT_NE(scene.reports().sending(), nullptr);
  EXPECT_EQ(scene.reports().sending()->number, 2);
  EXPECT_TRUE(scene.reports().sending()->asked);
}

TEST(ResubmittedReport, IsNotSentTwiceIfItsPostIsRetried) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer());
  scene.post(1, "Drill", true);
  const ClientId retry = scene.post(1, "Drill", true);
  EXPECT_EQ(scene.count(), 2);
  scene.answer(recorded_answer(0, "scored", "1", 107));
  EXPECT_EQ(scene.answer_to(retry).body, recorded_answer(0, "scored", "1", 107).body);
}

TEST(NearbyReport, IsHeldWithItsReason) {
  Scene scene(reviewing(Review::Duplicates));
  scene.post(1);
  scene.answer(recorded_answer());
  const ClientId near = scene.post(4.26);
  EXPECT_EQ(scene.state(2), Held);
  EXPECT_EQ(scene.report(2).note, "the same type as report 1, 3.3 m from it");
  scene.wait(20);
  EXPECT_EQ(scene.answer_to(near).status, 503);
  EXPECT_THAT(scene.answer_to(near).sentence, HasSubstr("is held until the operator decides (the same type"));
  scene.receive_status(19, 0);
  scene.post(7, "Drill");
  EXPECT_EQ(scene.state(3), Held) << "near the held report";
  scene.post(1, "Vent");
  EXPECT_EQ(scene.state(4), Sending) << "another type";
}

TEST(NearbyReport, IsNotHeldForAnUnscoredReport) {
  Scene scene(reviewing(Review::Duplicates));
  scene.post(1);
  scene.answer(answer_of(422));
  scene.post(2);
  scene.answer(recorded_answer(0, "admin stop"));
  scene.post(3);
  EXPECT_EQ(scene.state(3), Sending);
}

TEST(ReviewOfAllReports, HoldsEachUntilTheOperatorSendsIt) {
  Scene scene(reviewing(Review::All));
  scene.post(1);
  scene.post(2);
  EXPECT_EQ(scene.send_next(), 0);
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  ASSERT_EQ(scene.send_next(), 1);
  scene.answer(recorded_answer());
  EXPECT_EQ(scene.state(2), Held) << "an answer releases no other report";
}

}  // namespace
}  // namespace adit::dispatch
