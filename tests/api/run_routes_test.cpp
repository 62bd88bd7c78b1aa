#include "api/run_routes.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/on_page.hpp"

namespace adit::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class RunRoutesTest : public OnPage {
 protected:
  intake::Answer identify(const std::string& body) { return post("/adit/identify", body); }
};

TEST_F(RunRoutesTest, PassOnActionsOnRejectedMessages) {
  const auto sent = post("/adit/rejected/7/send");
  EXPECT_EQ(sent.status, icd::Status::Ok);
  EXPECT_EQ(sent.body, R"({"rejected":7})");
  EXPECT_EQ(post("/adit/rejected/8/discard").status, icd::Status::Ok);
  EXPECT_THAT(decisions.decided_messages,
              ElementsAre(Pair(7, RejectedAction::Send), Pair(8, RejectedAction::Discard)));
}

TEST_F(RunRoutesTest, TellWhyAnActionOnARejectedMessageFails) {
  decisions.rejected_trouble = "something newer was sent since";
  const auto answer = post("/adit/rejected/7/send");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(answer.body, R"("something newer was sent since")");
}

TEST_F(RunRoutesTest, RejectInvalidNumbersOfRejectedMessages) {
  for (const char* const wrong :
       {"/adit/rejected/", "/adit/rejected/7", "/adit/rejected/x/send", "/adit/rejected/7/hold",
        "/adit/rejected/-1/send", "/adit/rejected/7/send/more"}) {
    EXPECT_EQ(post(wrong).status, icd::Status::NotFound) << wrong;
  }
  EXPECT_TRUE(decisions.decided_messages.empty());
}

TEST_F(RunRoutesTest, ReplaceAnUnreadableLedger) {
  EXPECT_EQ(post("/adit/ledger/new").body, R"({"kept_as":"ledger.damaged-1"})");
  decisions.ledger = std::unexpected(icd::Refusal{icd::Status::Conflict, "the ledger can be read"});
  const auto answer = post("/adit/ledger/new");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(answer.body, R"("the ledger can be read")");
}

TEST_F(RunRoutesTest, BlinkTheLightsAndTellUntilWhen) {
  const auto answer = identify(R"({"seconds": 12.5})");
  EXPECT_EQ(answer.status, icd::Status::Ok);
  EXPECT_EQ(nlohmann::json::parse(answer.body)["identify_until"], 1012.5);
  EXPECT_EQ(decisions.identified, 12.5);
}

TEST_F(RunRoutesTest, NameTheWrongFieldOfABlink) {
  for (const char* wrong : {R"({"seconds": 0})", R"({"seconds": 60.5})", R"({"seconds": -1})",
                            R"({"seconds": "10"})", R"({"seconds": null})", "{}"}) {
    const auto answer = identify(wrong);
    EXPECT_EQ(answer.status, icd::Status::UnprocessableEntity) << wrong;
    EXPECT_THAT(answer.body, HasSubstr("seconds: ")) << wrong;
  }
  EXPECT_EQ(identify("").status, icd::Status::BadRequest);
  EXPECT_EQ(identify("seconds=10").status, icd::Status::BadRequest);
  EXPECT_EQ(identify("[10]").status, icd::Status::UnprocessableEntity);
  EXPECT_EQ(decisions.identified, 0);
}

TEST_F(RunRoutesTest, AcknowledgeAnAlarmByItsId) {
  const auto acknowledge = [this](const char* body) { return post("/adit/alarms/acknowledge", body); };
  EXPECT_EQ(acknowledge(R"({"id": "robot_silent:uav5"})").body, R"({"acknowledged":"robot_silent:uav5"})");
  EXPECT_THAT(decisions.acknowledged, testing::ElementsAre("robot_silent:uav5"));
  for (const char* wrong : {"{}", R"({"id": 5})", R"({"id": null})", "[]"})
    EXPECT_EQ(acknowledge(wrong).status, icd::Status::UnprocessableEntity) << wrong;
  EXPECT_EQ(acknowledge("").status, icd::Status::BadRequest);
  decisions.alarm_trouble = "there is no such alarm any more";
  const auto gone = acknowledge(R"({"id": "robot_silent:uav6"})");
  EXPECT_EQ(gone.status, icd::Status::Conflict);
  EXPECT_EQ(gone.body, "\"there is no such alarm any more\"");
  EXPECT_EQ(decisions.acknowledged.size(), 1u);
}

TEST_F(RunRoutesTest, DeclareANewRun) {
  EXPECT_EQ(post("/adit/runs").body, "{\"run\":2}");
  EXPECT_EQ(decisions.run, 2);
}

}  // namespace
}  // namespace adit::api
