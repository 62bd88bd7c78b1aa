#include "update/messages.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace adit::update {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kNonce = "0123456789abcdef0123456789abcdef";

Status a_status() {
  return {.trouble = "none",
          .running = {"adit-qemu-virt", "0.1.0", "A", "B"},
          .nonce = kNonce,
          .refusal = "no",
          .doing = "installing",
          .progress = 40,
          .last = {Stage::Left, "0.2.0", "B", "boot", "it did not"},
          .trial = true,
          .stick = Offer{"adit-0.3.0.raucb", "0.3.0"},
          .stick_trouble = "too old"};
}

TEST(Messages, ReadBackTheSame) {
  for (const auto what : {Request::Command::Install, Request::Command::Stick, Request::Command::Restart}) {
    const auto request = codec::read_file<Request>(codec::write_file(Request{kNonce, what, true}));
    ASSERT_TRUE(request) << request.error();
    EXPECT_EQ(request->nonce, kNonce);
    EXPECT_EQ(request->what, what);
    EXPECT_TRUE(request->again);
  }
  const auto status = codec::read_file<Status>(codec::write_file(a_status()));
  ASSERT_TRUE(status) << status.error();
  EXPECT_EQ(*status, a_status());
  const auto none = codec::read_file<Status>(codec::write_file(Status{}));
  ASSERT_TRUE(none) << none.error();
  EXPECT_EQ(*none, Status{});
  for (const Stage stage : {Stage::None, Stage::Installing, Stage::Interrupted, Stage::Failed,
                            Stage::Installed, Stage::Left, Stage::Good}) {
    const LastUpdate last_update{stage, "0.2.0", "B", "boot", "why"};
    const auto result = codec::read_file<LastUpdate>(codec::write_file(last_update));
    ASSERT_TRUE(result) << result.error();
    EXPECT_EQ(*result, last_update);
  }
}

TEST(Messages, OutsideTheirBoundsAreRejected) {
  json request = json::parse(codec::write_file(Request{kNonce, Request::Command::Install, false}));
  request["what"] = "erase";
  EXPECT_THAT(codec::read_file<Request>(request.dump()).error(),
              HasSubstr("install, stick, restart, back or stay"));
  request["what"] = "stick";
  for (const char* nonce :
       {"", "0123", "0123456789ABCDEF0123456789abcdef", "../../../../etc/passwd0000000000"}) {
    request["nonce"] = nonce;
    EXPECT_THAT(codec::read_file<Request>(request.dump()).error(), HasSubstr("hexadecimal")) << nonce;
  }
  json status = json::parse(codec::write_file(a_status()));
  for (const int percent : {-1, 101}) {
    status["progress"] = percent;
    EXPECT_FALSE(codec::read_file<Status>(status.dump())) << percent;
  }
  status = json::parse(codec::write_file(a_status()));
  status["last"]["stage"] = "lost";
  EXPECT_THAT(codec::read_file<Status>(status.dump()).error(), HasSubstr("last.stage"));
  status = json::parse(codec::write_file(a_status()));
  status["running"]["more"] = "x";
  EXPECT_THAT(codec::read_file<Status>(status.dump()).error(), HasSubstr("running"));
}

}  // namespace
}  // namespace adit::update
