#include <gtest/gtest.h>

#include "codec/read.hpp"
#include "dispatch/verdicts.hpp"

namespace adit::dispatch {
namespace {

constexpr const char* kReply = R"({"report_status": "scored", "score_change": 1})";

struct ReportCase {
  int status;
  const char* body;
  ReportEvent event;
};
void PrintTo(const ReportCase& one, std::ostream* out) {
  *out << one.status << " " << one.body;
}

const ReportCase kReportCases[] = {
    {200, kReply, ReportEvent::Recorded},
    {201, "", ReportEvent::Lost},
    {200, "<html>log in to the network</html>", ReportEvent::Lost},
    {200, R"({"report_status": "scored"})", ReportEvent::Lost},
    {204, "", ReportEvent::Lost},
    {302, "", ReportEvent::Lost},
    {400, "\"bad\"", ReportEvent::Rejected},
    {401, "\"token\"", ReportEvent::Barred},
    {403, "", ReportEvent::Barred},
    {404, "<html>", ReportEvent::Barred},
    {405, "", ReportEvent::Barred},
    {407, "", ReportEvent::Barred},
    {408, "", ReportEvent::Lost},
    {422, kReply, ReportEvent::Rejected},
    {400, "<html>blocked by the firewall</html>", ReportEvent::Lost},
    {451, "not here", ReportEvent::Lost},
    {429, "<html>slow down</html>", ReportEvent::Throttled},
    {429, "", ReportEvent::Throttled},
    {500, kReply, ReportEvent::Lost},
    {999, "", ReportEvent::Lost},
};

class ReportVerdicts : public testing::TestWithParam<ReportCase> {};

TEST_P(ReportVerdicts, FollowStatusAndBody) {
  const std::string body = GetParam().body;
  EXPECT_EQ(event_of(GetParam().status, codec::read_report_reply(body).has_value(), body_of(body)),
            GetParam().event);
}
INSTANTIATE_TEST_SUITE_P(Answers, ReportVerdicts, testing::ValuesIn(kReportCases));

TEST(ARedirect, LeavesNoDoubtOnlyIfTheServerDidNotProcessTheReport) {
  for (const int status : {302, 307, 308}) EXPECT_EQ(event_of(status, false, Body::Other), ReportEvent::Lost);
  EXPECT_EQ(event_of(308, false, Body::Other, /*is_unprocessed=*/true), ReportEvent::Redirected);
}

Report with_answer(ReportState state, const std::string& answer, bool reconciled = false) {
  Report report{.state = state, .status = 201, .answer = answer};
  report.reconciled = reconciled;
  return report;
}

icd::ReportReply unscored(const std::string& report_status) {
  icd::ReportReply reply;
  reply.report_status = report_status;
  return reply;
}

TEST(AnAnswer, IsAboutAnotherReportIfThatIsOfAnotherTypeOrPlace) {
  const icd::ArtifactReport sent{.type = "Drill", .position = {10, 20, 3}};
  const auto answer_about = [](const char* type, double x) {
    icd::ReportReply reply;
    reply.report = {.type = type, .position = {x, 20, 3}};
    return reply;
  };
  EXPECT_FALSE(is_about_another({}, sent)) << "it names no report";
  EXPECT_FALSE(is_about_another(answer_about("Drill", 10), sent));
  EXPECT_FALSE(is_about_another(answer_about("drill", 10.9), sent)) << "rounded";
  EXPECT_TRUE(is_about_another(answer_about("Drill", 11.1), sent));
  EXPECT_TRUE(is_about_another(answer_about("Rope", 10), sent));
}

TEST(Effect, OfAScoredReportIsItsPoints) {
  const Effect effect = effect_of(with_answer(ReportState::Answered, kReply));
  EXPECT_TRUE(effect.scored);
  EXPECT_FALSE(effect.again);
  EXPECT_EQ(effect.points, 1);
}

TEST(Effect, AllowsARepeatAfterAnUnscoredPhase) {
  for (const std::string status : {"admin stop", "run not started"}) {
    const Effect effect = effect_of(unscored(status));
    EXPECT_FALSE(effect.scored) << status;
    EXPECT_TRUE(effect.again) << status;
  }
  for (const std::string status : {"report limit exceeded", "time limit exceeded", "something new"}) {
    const Effect effect = effect_of(unscored(status));
    EXPECT_FALSE(effect.scored) << status;
    EXPECT_FALSE(effect.again) << status;
  }
}

TEST(Effect, CountsAReconciledReportAsScored) {
  EXPECT_TRUE(effect_of(with_answer(ReportState::Settled, kReply, true)).scored);
  EXPECT_TRUE(effect_of(with_answer(ReportState::Settled, R"({"score_change": null})", true)).scored);
}

TEST(Effect, IsNoneIfNothingIsKnownToBeRecorded) {
  EXPECT_FALSE(effect_of(with_answer(ReportState::Settled, kReply)).scored) << "settled by the operator";
  for (const ReportState state : {ReportState::Rejected, ReportState::InDoubt, ReportState::Queued,
                                  ReportState::Sending, ReportState::Held, ReportState::Withdrawn}) {
    EXPECT_FALSE(effect_of(with_answer(state, kReply)).scored) << name_of(state);
  }
}

}  // namespace
}  // namespace adit::dispatch
