#include "api/update_routes.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/on_page.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<intake::Header> kBytes = {kByToken, {"Content-Type", "application/octet-stream"}};

class UpdateRoutesTest : public OnPage {
 protected:
  intake::Answer ask(const std::string& method, const std::string& target, const std::string& body = "",
                     std::vector<intake::Header> headers = kJsonByToken) {
    return request(method, target, std::move(headers), body);
  }
};

TEST_F(UpdateRoutesTest, TellWhatRuns) {
  updates.view.managed = true;
  updates.view.running = {"adit-qemu-virt", "0.1.0", "A", "B"};
  EXPECT_EQ(json::parse(ask("GET", "/adit/update").body), json::parse(R"({
    "managed": true, "why": "", "board": "adit-qemu-virt", "version": "0.1.0", "slot": "A", "trial": false,
    "doing": null, "progress": null, "refusal": null, "last": null, "stick": null, "stick_why": null})"));
}

TEST_F(UpdateRoutesTest, TellOfAnUpdate) {
  updates.view.why = "RAUC does not run here";
  updates.view.doing = "installing";
  updates.view.progress = 40;
  updates.view.refusal = "it is older";
  updates.view.trial = true;
  updates.view.last = {update::Stage::Left, "0.2.0", "B", "boot", "it did not"};
  updates.view.stick = update::Offer{"adit-x.raucb", "0.3.0"};
  updates.view.stick_why = "too old";
  const json shown = json::parse(ask("GET", "/adit/update").body);
  EXPECT_EQ(shown["why"], "RAUC does not run here");
  EXPECT_EQ(shown["doing"], "installing");
  EXPECT_EQ(shown["progress"], 40);
  EXPECT_EQ(shown["refusal"], "it is older");
  EXPECT_EQ(shown["trial"], true);
  EXPECT_EQ(shown["last"],
            json::parse(R"({"stage": "left", "version": "0.2.0", "slot": "B", "why": "it did not"})"));
  EXPECT_EQ(shown["stick"], json::parse(R"({"name": "adit-x.raucb", "version": "0.3.0"})"));
  EXPECT_EQ(shown["stick_why"], "too old");
}

TEST_F(UpdateRoutesTest, HandABundleOnAsItComes) {
  const auto exchange = open("POST", "/adit/update?again=1", kBytes, 6);
  ASSERT_TRUE(exchange);
  EXPECT_EQ(updates.received.size, 6u);
  EXPECT_TRUE(updates.received.again);
  const std::uint8_t first[] = {'a', 'b', 'c'}, second[] = {'d', 'e', 'f'};
  EXPECT_TRUE(exchange->on_body(first));
  updates.more = false;
  EXPECT_FALSE(exchange->on_body(second)) << "a full disk's queue holds up whoever sends";
  updates.received.resume();
  EXPECT_EQ(flow->resumed, 1);
  exchange->on_end();
  EXPECT_FALSE(responder->answered) << "it is not on the disk yet";
  updates.received.done({});
  EXPECT_EQ(updates.received.bytes, "abcdef");
  EXPECT_EQ(responder->answered->status, icd::Status::Ok);
  EXPECT_TRUE(json::parse(responder->answered->body).contains("version"));
}

TEST_F(UpdateRoutesTest, SayWhyABundleCouldNotBeTaken) {
  const auto exchange = open("POST", "/adit/update", kBytes, 6);
  EXPECT_FALSE(updates.received.again);
  exchange->on_end();
  updates.received.done(std::unexpected(icd::Refusal{icd::Status::ServiceUnavailable, "no room"}));
  EXPECT_EQ(responder->answered->status, icd::Status::ServiceUnavailable);
  EXPECT_EQ(responder->answered->body, R"("no room")");
  updates.outcome = std::unexpected(icd::Refusal{icd::Status::Conflict, "another comes"});
  EXPECT_EQ(ask("POST", "/adit/update", "x", kBytes).body, R"("another comes")");
}

TEST_F(UpdateRoutesTest, ForgetABundleWhoseSenderWentAway) {
  const auto exchange = open("POST", "/adit/update", kBytes, 6);
  exchange->on_gone();
  EXPECT_TRUE(updates.received.dropped);
}

TEST_F(UpdateRoutesTest, RefuseABodyThatIsNoBundle) {
  const auto refused = [this](std::vector<intake::Header> headers, std::optional<std::uint64_t> length,
                              const std::string& target = "/adit/update") {
    EXPECT_FALSE(open("POST", target, std::move(headers), length));
    return *responder->answered;
  };
  EXPECT_THAT(refused(kBytes, 0).body, HasSubstr("Content-Length"));
  EXPECT_THAT(refused(kBytes, std::nullopt).body, HasSubstr("Content-Length"));
  EXPECT_THAT(refused(kBytes, 5, "/adit/update?again=yes").body, HasSubstr("again: expected 0 or 1"));
  EXPECT_EQ(updates.received.size, 0u);
}

TEST_F(UpdateRoutesTest, InstallFromTheStickAndRestartOnTheOperatorsWord) {
  EXPECT_EQ(ask("POST", "/adit/update/stick").status, icd::Status::Ok);
  EXPECT_EQ(ask("POST", "/adit/update/stick", R"({"again": true})").status, icd::Status::Ok);
  EXPECT_THAT(updates.sticks, ElementsAre(false, true));
  EXPECT_EQ(ask("POST", "/adit/update/restart", "{}").status, icd::Status::Ok);
  updates.outcome = std::unexpected(icd::Refusal{icd::Status::Conflict, "report 7 is being sent"});
  const auto refused = ask("POST", "/adit/update/restart", R"({"anyway": true})");
  EXPECT_EQ(refused.status, icd::Status::Conflict);
  EXPECT_EQ(refused.body, R"("report 7 is being sent")");
  EXPECT_THAT(updates.restarts, ElementsAre(false, true));
}

TEST_F(UpdateRoutesTest, RefuseAActionThatIsNotWellSaid) {
  for (const char* path : {"/adit/update/stick", "/adit/update/restart"}) {
    EXPECT_EQ(ask("POST", path, "{").status, icd::Status::BadRequest) << path;
    EXPECT_EQ(ask("POST", path, "[]").status, icd::Status::UnprocessableEntity) << path;
    EXPECT_EQ(ask("POST", path, R"({"again": "x", "anyway": "x"})").status, icd::Status::UnprocessableEntity);
  }
  EXPECT_THAT(updates.sticks, IsEmpty());
  EXPECT_THAT(updates.restarts, IsEmpty());
}

}  // namespace
}  // namespace adit::api
