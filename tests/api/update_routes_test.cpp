#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/box_routes.hpp"
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

TEST_F(UpdateRoutesTest, ShowTheRunningVersion) {
  updates.view.managed = true;
  updates.view.status.running = {"adit-qemu-virt", "0.1.0", "A", "B"};
  EXPECT_EQ(json::parse(ask("GET", "/adit/update").body), json::parse(R"({
    "managed": true, "why": "", "runs_here": false, "board": "adit-qemu-virt", "version": "0.1.0", "slot": "A", "other_slot": "B", "trial": false,
    "doing": null, "stray": null, "progress": null, "refusal": null, "last": null, "stick": null, "stick_why": null,
    "newer": null, "newer_why": null})"));
}

TEST_F(UpdateRoutesTest, ShowAnUpdate) {
  updates.view.why = "RAUC does not run here";
  updates.view.status.doing = "installing";
  updates.view.status.progress = 40;
  updates.view.status.refusal = "the update is older";
  updates.view.status.trial = true;
  updates.view.status.last = {update::Stage::Left, "0.2.0", "B", "boot", "it did not"};
  updates.view.status.stick = update::Offer{"adit-x.raucb", "0.3.0"};
  updates.view.status.stick_trouble = "too old";
  updates.view.newer = "";
  updates.view.newer_why = "no";
  const json shown = json::parse(ask("GET", "/adit/update").body);
  EXPECT_EQ(shown["why"], "RAUC does not run here");
  EXPECT_EQ(shown["doing"], "installing");
  EXPECT_EQ(shown["progress"], 40);
  EXPECT_EQ(shown["refusal"], "the update is older");
  EXPECT_EQ(shown["trial"], true);
  EXPECT_EQ(shown["last"],
            json::parse(R"({"stage": "left", "version": "0.2.0", "slot": "B", "why": "it did not"})"));
  EXPECT_EQ(shown["stick"], json::parse(R"({"name": "adit-x.raucb", "version": "0.3.0"})"));
  EXPECT_EQ(shown["stick_why"], "too old");
  EXPECT_EQ(shown["newer"], "") << "no newer version is known";
  EXPECT_EQ(shown["newer_why"], "no");
}

/// The head of a squashfs of `used` bytes.
std::vector<std::uint8_t> head(std::uint8_t used = 40) {
  std::vector<std::uint8_t> bytes(update::kBundleHead);
  std::ranges::copy(std::string_view("hsqs"), bytes.begin());
  bytes[40] = used;
  return bytes;
}

TEST_F(UpdateRoutesTest, PassOnABundleInPieces) {
  const auto exchange = open("POST", "/adit/update?again=1", kBytes, 51);
  ASSERT_TRUE(exchange);
  EXPECT_EQ(updates.received.size, 51u);
  EXPECT_TRUE(updates.received.again);
  const std::vector<std::uint8_t> first = head(), second = {'d', 'e', 'f'};
  EXPECT_TRUE(exchange->on_body(std::span(first).first(7)));
  EXPECT_TRUE(exchange->on_body(std::span(first).subspan(7)));
  updates.more = false;
  EXPECT_FALSE(exchange->on_body(second)) << "a full queue must delay the sender";
  updates.received.resume();
  EXPECT_EQ(flow->resumed, 1);
  exchange->on_end();
  EXPECT_FALSE(responder->answered) << "answered before the update is on the disk";
  updates.received.done({});
  EXPECT_EQ(updates.received.bytes, std::string(first.begin(), first.end()) + "def");
  EXPECT_EQ(responder->answered->status, icd::Status::Ok);
  EXPECT_TRUE(json::parse(responder->answered->body).contains("version"));
}

TEST_F(UpdateRoutesTest, RejectOtherFilesByTheirFirstBytes) {
  std::vector<std::uint8_t> image = head(), cut = head(60);
  image[0] = 0xfd;
  for (const auto& [bytes, why] :
       {std::pair(image, "the file is not an update: expected a file adit-BOARD-VERSION.raucb"),
        std::pair(cut, "the update is incomplete: expected more than 60 bytes, got 60")}) {
    const auto exchange = open("POST", "/adit/update", kBytes, 60);
    EXPECT_TRUE(exchange->on_body(bytes));
    ASSERT_TRUE(responder->answered) << "not answered before the rest arrives";
    EXPECT_EQ(responder->answered->status, icd::Status::UnprocessableEntity);
    EXPECT_EQ(json::parse(responder->answered->body), why);
    EXPECT_TRUE(updates.received.dropped);
    EXPECT_TRUE(exchange->on_body(bytes));  // later pieces are ignored
    exchange->on_end();
    EXPECT_FALSE(updates.received.whole);
  }
}

TEST_F(UpdateRoutesTest, RejectAFileShorterThanTheSignature) {
  const auto exchange = open("POST", "/adit/update", kBytes, 4);
  EXPECT_TRUE(exchange->on_body(std::span<const std::uint8_t>(head()).first(4)));
  EXPECT_FALSE(responder->answered);
  exchange->on_end();
  EXPECT_EQ(responder->answered->status, icd::Status::UnprocessableEntity);
  EXPECT_TRUE(updates.received.dropped);
}

TEST_F(UpdateRoutesTest, TellWhyABundleWasRejected) {
  const auto exchange = open("POST", "/adit/update", kBytes, 48);
  EXPECT_FALSE(updates.received.again);
  exchange->on_body(head());
  exchange->on_end();
  updates.received.done(std::unexpected(icd::Refusal{icd::Status::ServiceUnavailable, "no room"}));
  EXPECT_EQ(responder->answered->status, icd::Status::ServiceUnavailable);
  EXPECT_EQ(responder->answered->body, R"("no room")");
  updates.outcome = std::unexpected(icd::Refusal{icd::Status::Conflict, "another comes"});
  EXPECT_EQ(ask("POST", "/adit/update", "x", kBytes).body, R"("another comes")");
}

TEST_F(UpdateRoutesTest, DropABundleWhoseSenderDisconnects) {
  const auto exchange = open("POST", "/adit/update", kBytes, 6);
  exchange->on_gone();
  EXPECT_TRUE(updates.received.dropped);
}

TEST_F(UpdateRoutesTest, RejectAnInvalidLengthOrOption) {
  const auto refused = [this](std::vector<intake::Header> headers, std::optional<std::uint64_t> length,
                              const std::string& target = "/adit/update") {
    EXPECT_FALSE(open("POST", target, std::move(headers), length));
    return *responder->answered;
  };
  EXPECT_THAT(refused(kBytes, 0).body, HasSubstr("Content-Length"));
  EXPECT_THAT(refused(kBytes, std::nullopt).body, HasSubstr("Content-Length"));
  EXPECT_EQ(refused(kBytes, 1u << 30).status, icd::Status::ContentTooLarge);
  EXPECT_THAT(refused(kBytes, 5, "/adit/update?again=yes").body, HasSubstr("again: expected 0 or 1"));
  EXPECT_EQ(updates.received.size, 0u);
}

TEST_F(UpdateRoutesTest, InstallFromTheStickAndRestartOnRequest) {
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

TEST_F(UpdateRoutesTest, GoBackToTheExpectedSlotOrStay) {
  updates.view.status.stray = "slot B runs, with 0.1.0";
  EXPECT_EQ(json::parse(ask("GET", "/adit/update").body)["stray"], "slot B runs, with 0.1.0");
  EXPECT_EQ(ask("POST", "/adit/update/back", R"({"anyway": true})").status, icd::Status::Ok);
  EXPECT_THAT(updates.backs, ElementsAre(true));
  EXPECT_EQ(ask("POST", "/adit/update/stay").status, icd::Status::Ok);
  EXPECT_EQ(updates.stays, 1);
}

TEST_F(UpdateRoutesTest, RejectAMalformedAction) {
  for (const char* path : {"/adit/update/stick", "/adit/update/restart", "/adit/update/back"}) {
    EXPECT_EQ(ask("POST", path, "{").status, icd::Status::BadRequest) << path;
    EXPECT_EQ(ask("POST", path, "[]").status, icd::Status::UnprocessableEntity) << path;
    EXPECT_EQ(ask("POST", path, R"({"again": "x", "anyway": "x"})").status, icd::Status::UnprocessableEntity);
  }
  EXPECT_THAT(updates.sticks, IsEmpty());
  EXPECT_THAT(updates.restarts, IsEmpty());
}

}  // namespace
}  // namespace adit::api
