#include <gmock/gmock.h>

#include "codec/read.hpp"
#include "dispatch/doubts.hpp"

namespace adit::dispatch {
namespace {

using testing::HasSubstr;

Report found() {
  Report report{.number = 12, .report = {"cell phone", {1.5, -2, 0}}};
  report.sent = 1700000000.25;
  report.before = icd::RunStatus{3, 721.4, 14, "subt"};
  return report;
}

const Run kRun{.id = "1.5.2", .last = icd::RunStatus{4, 733, 13, "subt"}};

TEST(ReconciledAnswer, HasTheKnownFields) {
  const std::string body = reconciled_answer(found(), kRun, 1, "from 14 to 13");
  for (const char* const field :
       {R"("x":1.5)", R"("y":-2.0)", R"("z":0.0)", R"("type":"cell phone")",
        R"("submitted_datetime":"2023-11-14T22:13:20.250000+00:00")", R"("run_clock":721.4)",
        R"("team":"subt")", R"("run":"1.5.2")", R"("report_status":"scored")", R"("score_change":1)"}) {
    EXPECT_THAT(body, HasSubstr(field));
  }
}

TEST(ReconciledAnswer, NamesItsOriginAndEvidence) {
  EXPECT_THAT(reconciled_answer(found(), kRun, 1, "from 14 to 13"),
              HasSubstr(R"("adit":{"reconciled":true,"report":12,"evidence":"from 14 to 13"})"));
}

TEST(ReconciledAnswer, HasNullForUnknownFields) {
  const std::string body = reconciled_answer(found(), dispatch::Run{}, std::nullopt, "");
  for (const char* const field :
       {R"("url":null)", R"("id":null)", R"("team":null)", R"("run":null)", R"("score_change":null)"}) {
    EXPECT_THAT(body, HasSubstr(field));
  }
}

TEST(ReconciledAnswer, IsReadLikeAnAnswerOfTheCommandPost) {
  const auto reply = codec::read_report_reply(reconciled_answer(found(), kRun, 0, ""));
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->report_status, "scored");
  EXPECT_EQ(reply->score_change, 0);
  EXPECT_EQ(reply->run, "1.5.2");
}

}  // namespace
}  // namespace adit::dispatch
