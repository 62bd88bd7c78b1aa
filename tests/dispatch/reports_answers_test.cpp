// The table of answers in the README of dispatch.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(A2xx, IsPassedOnByteForByte) {
  Scene scene;
  const ClientId client = scene.post();
  scene.answer(recorded_answer(1));
  EXPECT_EQ(scene.state(1), Answered);
  EXPECT_EQ(scene.answer_to(client).status, 201);
  EXPECT_EQ(scene.answer_to(client).body, recorded_answer(1).body);
  EXPECT_EQ(scene.output().ledger.at(1).answer, recorded_answer(1).body) << "on disk";
}

TEST(A2xx, OfAnUnscoredReportIsExplainedToTheOperator) {
  Scene scene;
  scene.post();
  scene.answer(recorded_answer(0, "admin stop"));
  EXPECT_EQ(scene.report(1).note, "not scored (admin stop); post it again when the run continues");
}

TEST(A2xx, WithoutAReportPutsTheReportInDoubt) {
  Scene scene;
  const ClientId client = scene.post();
  scene.answer({200, "text/html", "<html>log in</html>"});
  EXPECT_EQ(scene.state(1), InDoubt);
  EXPECT_FALSE(scene.is_answered(client));
  scene.receive_status(19, 0);
  scene.wait(1);
  scene.receive_status(19, 0);
  EXPECT_EQ(scene.answer_to(client).status, 201);
}

/// An answer that names a report.
HttpAnswer answer_about(double x, const std::string& type = "Drill") {
  HttpAnswer answer = recorded_answer();
  answer.body.pop_back();
  answer.body += icd::sentence(R"(, "type": ")", type, R"(", "x": )", x, R"(, "y": 0, "z": 0})");
  return answer;
}

/// A server or proxy that repeats its last answer.
TEST(A2xx, OfAnotherReportPutsTheReportInDoubt) {
  Scene scene;
  scene.post(10);
  scene.answer(answer_about(10));
  scene.receive_status(19, 0);
  scene.wait(1);
  const ClientId client = scene.post(11);
  scene.answer(answer_about(10));
  EXPECT_EQ(scene.state(2), InDoubt);
  EXPECT_THAT(scene.report(2).note, HasSubstr("the answer is for report 1, not for this report"));
  EXPECT_FALSE(scene.is_answered(client));
  scene.repeat_status(14, 19, 0);
  EXPECT_EQ(scene.state(2), Queued) << "not recorded";
  EXPECT_EQ(scene.send_next(), 2);
  scene.answer(answer_about(11));
  EXPECT_EQ(scene.answer_to(client).body, answer_about(11).body);
}

TEST(A2xx, OfAStrangeReportLeavesTheCountsUncertain) {
  Scene scene;
  scene.post(10);
  scene.answer(answer_about(500));
  EXPECT_EQ(scene.state(1), Answered);
  EXPECT_FALSE(scene.reports().expected_status(scene.time().now)) << "its score is another report's";
  scene.receive_status(19, 0);
  EXPECT_TRUE(scene.reports().expected_status(scene.time().now));
}

TEST(A2xx, OfAReportOfTheLastRunPutsItInDoubt) {
  Scene scene;
  scene.post(10);
  scene.answer(answer_about(10));
  scene.reports().declare_new_run(scene.time());
  scene.post(11);
  scene.answer(answer_about(10));
  EXPECT_EQ(scene.state(2), InDoubt);
}

TEST(A2xx, WithRoundedFiguresCountsAndIsNoted) {
  Scene scene;
  scene.post(10.4);
  scene.answer(answer_about(10));  // rounded
  EXPECT_EQ(scene.state(1), Answered);
  EXPECT_EQ(scene.report(1).note, R"(the answer is for "Drill" at 10, 0, 0)");
  scene.post(20);
  scene.answer(answer_about(20.0000001, "drill"));
  EXPECT_EQ(scene.report(2).note, "");
  scene.post(10.2);
  scene.answer(recorded_answer());  // without type and position
  EXPECT_EQ(scene.state(3), Answered);
}

TEST(A429, LeavesTheReportQueuedInItsPlace) {
  Scene scene;
  const ClientId client = scene.post(1);
  scene.post(2);
  for (int i = 0; i < 10; ++i) {
    scene.answer(answer_of(429));
    EXPECT_EQ(scene.state(1), Queued);
    EXPECT_FALSE(scene.is_answered(client));
    scene.wait(1);
    ASSERT_EQ(scene.send_next(), 1) << "before report 2";
    EXPECT_EQ(scene.report(1).status, 0) << "the earlier answer is cleared";
    EXPECT_THAT(scene.report(1).answer, IsEmpty());
  }
  EXPECT_EQ(scene.report(1).tries, 0);
  scene.answer(recorded_answer());
  EXPECT_EQ(scene.answer_to(client).status, 201);
}

TEST(A401, LeavesTheReportQueuedUntilAStatusIsAnswered) {
  Scene scene;
  const ClientId client = scene.post(1);
  const ClientId other = scene.post(2);
  scene.answer(answer_of(401));
  EXPECT_EQ(scene.state(1), Queued);
  EXPECT_EQ(scene.answer_to(client).status, 503);
  EXPECT_THAT(scene.answer_to(client).sentence, HasSubstr("is queued (the Command Post's words)"));
  EXPECT_FALSE(scene.is_answered(other));
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_EQ(scene.reports().next_requests(scene.time()).status, scene.time().now);
  scene.reports().on_status_failed(NoStatus::Other, scene.time());
  EXPECT_EQ(scene.send_next(), 0);
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(APageForAStatus, HoldsReportsBackUntilAStatusIsAnswered) {
  Scene scene;
  scene.reports().on_status_failed(NoStatus::Page, scene.time());
  scene.post(1);
  scene.post(2, "Drill", /*resubmit=*/true);
  EXPECT_EQ(scene.state(1), Queued) << "although a status proves the run";
  EXPECT_EQ(scene.send_next(), 0);
  EXPECT_EQ(scene.reports().next_requests(scene.time()).status, scene.time().now);
  scene.wait(20);
  scene.reports().on_status_failed(NoStatus::Page, scene.time());
  EXPECT_EQ(scene.send_next(), 0);
  scene.receive_status(20, 0);
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(APageForAStatus, HoldsNoReportThatTheOperatorSends) {
  Scene scene;
  scene.wait(20);
  scene.reports().on_status_failed(NoStatus::Page, scene.time());
  scene.post(1);
  scene.post(2);
  ASSERT_TRUE(scene.reports().hold(2, scene.time()));
  ASSERT_TRUE(scene.reports().send(2, scene.time()));
  EXPECT_EQ(scene.send_next(), 2);
  scene.answer({200, "text/html", "<html>"});
  EXPECT_EQ(scene.state(2), InDoubt);
  scene.receive_status(20, 0);
  scene.reports().on_status_failed(NoStatus::Page, scene.time());
  EXPECT_EQ(scene.send_next(), 0) << "the order was for the page before";
}

TEST(AnotherFailureOfTheStatus, DelaysNoYoungReport) {
  Scene scene;
  scene.wait(20);
  scene.reports().on_status_failed(NoStatus::Page, scene.time());
  scene.post(1);
  EXPECT_EQ(scene.send_next(), 0);
  scene.reports().on_status_failed(NoStatus::Other, scene.time());
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(A422, IsTheClientsAnswer) {
  Scene scene;
  const ClientId client = scene.post();
  scene.answer(answer_of(422));
  EXPECT_EQ(scene.state(1), Rejected);
  EXPECT_EQ(scene.report(1).note, "the Command Post's words");
  EXPECT_EQ(scene.answer_to(client).status, 422);
  EXPECT_EQ(scene.answer_to(client).body, answer_of(422).body);
  EXPECT_EQ(scene.send_next(), 0);
}

TEST(A500, LeavesTheReportInDoubt) {
  Scene scene;
  const ClientId client = scene.post();
  scene.answer(answer_of(500));
  EXPECT_EQ(scene.state(1), InDoubt);
  EXPECT_TRUE(scene.reports().is_asking(scene.report(1)));
  EXPECT_FALSE(scene.is_answered(client));
}

TEST(NoByteLeft, LeavesTheReportQueued) {
  Scene scene;
  const ClientId client = scene.post();
  scene.reports().on_never_sent("connecting to 10.100.1.200:8000: Connection refused", scene.time());
  EXPECT_EQ(scene.state(1), Queued);
  EXPECT_EQ(scene.report(1).tries, 0);
  EXPECT_FALSE(scene.is_answered(client));
  EXPECT_EQ(scene.send_next(), 1);
}

TEST(UnansweredReport, IsHeldAfterFiveTries) {
  ReportRules rules;
  rules.answer_within = std::chrono::minutes(5);
  Scene scene(rules);
  const ClientId client = scene.post();
  for (std::int64_t tries = 1; tries <= Doubts::kMostTries; ++tries) {
    EXPECT_EQ(scene.state(1), Sending) << tries;
    scene.answer(answer_of(500));
    EXPECT_EQ(scene.report(1).tries, tries);
    scene.repeat_status(10, 20, 0);
    EXPECT_EQ(scene.send_next(), tries < Doubts::kMostTries ? 1 : 0);
  }
  EXPECT_EQ(scene.state(1), Held);
  EXPECT_EQ(scene.report(1).note, "sent 5 times without an answer, and not recorded");
  EXPECT_EQ(scene.answer_to(client).status, 503);
  scene.post(2);
  EXPECT_EQ(scene.state(2), Sending) << "later reports are not blocked";
}

TEST(UnansweredReport, HasFiveMoreTriesIfTheOperatorSendsIt) {
  Scene scene;
  scene.post();
  for (int i = 0; i < 5; ++i) {
    scene.lose_answer();
    scene.repeat_status(10, 20, 0);
    scene.send_next();
  }
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  ASSERT_EQ(scene.send_next(), 1);
  scene.lose_answer();
  scene.repeat_status(10, 20, 0);
  EXPECT_EQ(scene.send_next(), 1);
}

}  // namespace
}  // namespace adit::dispatch
