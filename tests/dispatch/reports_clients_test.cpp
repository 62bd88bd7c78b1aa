// Each client is answered once.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr const char* kNeverTwice =
    "post the same report again to ask for its state; Adit never sends it twice";

TEST(WaitingClient, IsAnsweredOnce) {
  Scene scene;
  const ClientId client = scene.post();
  scene.wait(20);
  scene.answer(recorded_answer());
  EXPECT_EQ(scene.output().answers[client].size(), 1);
  EXPECT_EQ(scene.answer_to(client).status, 504) << "a repeat gets the answer";
}

/// Answer at the deadline for a report in this state.
struct Telling {
  ReportState state;
  int status;
  const char* sentence;
};
void PrintTo(const Telling& telling, std::ostream* out) {
  *out << name_of(telling.state);
}

const Telling kTellings[] = {
    {Queued, 503, "report 1 is queued (why)"},
    {Held, 503, "report 1 is held until the operator decides (why)"},
    {InDoubt, 504, "report 1 is in doubt: it may or may not have been recorded (why)"},
};

class ClientAtItsDeadline : public testing::TestWithParam<Telling> {};

TEST_P(ClientAtItsDeadline, LearnsTheStateOfItsReport) {
  Scene scene;
  Report report;
  report.number = 1;
  report.report = {"Drill", {1, 0, 0}};
  report.run = 1;
  report.state = GetParam().state;
  report.note = "why";
  scene.output().ledger[1] = report;
  scene.restart();
  const ClientId client = scene.post_queued(1);
  scene.wait(19.9);
  EXPECT_FALSE(scene.is_answered(client));
  scene.wait(0.1);
  EXPECT_EQ(scene.answer_to(client).status, GetParam().status);
  EXPECT_EQ(scene.answer_to(client).number, 1);
  EXPECT_EQ(scene.answer_to(client).sentence, icd::sentence(GetParam().sentence, "; ", kNeverTwice));
}
INSTANTIATE_TEST_SUITE_P(States, ClientAtItsDeadline, testing::ValuesIn(kTellings));

TEST(WaitingClient, LearnsThatAReportInFlightMayBeRecorded) {
  Scene scene;
  const ClientId client = scene.post();
  scene.wait(20);
  EXPECT_EQ(scene.answer_to(client).status, 504);
  EXPECT_THAT(scene.answer_to(client).sentence,
              HasSubstr("is in flight, and may or may not have been recorded"));
}

TEST(WaitingClient, MayRepostAHeldReportOfAnEarlierRun) {
  Scene scene;
  const ClientId client = scene.post_queued(1);
  scene.wait(11);
  scene.receive_status(25, 0, 3);
  ASSERT_EQ(scene.state(1), Held);
  scene.wait(9);
  EXPECT_EQ(scene.answer_to(client).status, 503);
  EXPECT_THAT(scene.answer_to(client).sentence, Not(HasSubstr(kNeverTwice)));
  EXPECT_THAT(scene.answer_to(client).sentence, HasSubstr("post it again to send it in the present run"));
  scene.receive_status(25, 0, 12);
  scene.post(1);
  EXPECT_EQ(scene.state(2), Sending) << "as promised";
}

TEST(WaitingClient, OfARepeatWaitsForTheFirstReportWithinItsTime) {
  ReportRules rules;
  rules.answer_within = seconds(60);
  Scene scene(rules);
  scene.post_queued(1);
  ASSERT_TRUE(scene.reports().withdraw(1, scene.time()).has_value());
  scene.wait(16);
  const ClientId repeat = scene.post(1);  // compared later, because the run is unknown
  const auto deadline = scene.time().now + seconds(60);
  ASSERT_TRUE(scene.reports().send(1, scene.time()).has_value());
  scene.receive_status(20, 0);
  ASSERT_EQ(scene.send_next(), 1);
  scene.lose_answer();
  scene.repeat_stop(16, 117);
  scene.send_next();
  ASSERT_EQ(scene.report(2).same_as, 1);
  EXPECT_FALSE(scene.is_answered(repeat));
  EXPECT_EQ(scene.reports().next_deadline(), deadline);
  scene.repeat_status(2, 19, 0);
  EXPECT_EQ(scene.answer_to(repeat).status, 201);
  EXPECT_EQ(scene.answer_to(repeat).number, 1);
}

TEST(StopOfReports, AnswersClientsExceptThoseOfAReportInFlight) {
  Scene scene;
  const ClientId under_way = scene.post(1);
  const ClientId joined = scene.post(1);
  const ClientId waiting = scene.post(2);
  scene.reports().dismiss(false);
  EXPECT_EQ(scene.answer_to(waiting).status, 503);
  EXPECT_THAT(scene.answer_to(waiting).sentence, HasSubstr("the box is stopping; report 2 is queued"));
  EXPECT_FALSE(scene.is_answered(under_way));
  scene.answer(recorded_answer());
  EXPECT_EQ(scene.answer_to(under_way).status, 201);
  EXPECT_EQ(scene.answer_to(joined).status, 201);
}

}  // namespace
}  // namespace adit::dispatch
