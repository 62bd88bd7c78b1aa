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

TEST(Messages, SayWhatTheyWereGiven) {
  for (const auto what : {Request::What::Install, Request::What::Stick, Request::What::Restart}) {
    const auto request = read<Request>(write(Request{kNonce, what, true}));
    ASSERT_TRUE(request) << request.error();
    EXPECT_EQ(request->nonce, kNonce);
    EXPECT_EQ(request->what, what);
    EXPECT_TRUE(request->again);
  }
  const auto status = read<Status>(write(a_status()));
  ASSERT_TRUE(status) << status.error();
  EXPECT_EQ(*status, a_status());
  const auto none = read<Status>(write(Status{}));
  ASSERT_TRUE(none) << none.error();
  EXPECT_EQ(*none, Status{});
  for (const Stage stage : {Stage::None, Stage::Installing, Stage::Interrupted, Stage::Failed,
                            Stage::Installed, Stage::Left, Stage::Good}) {
    const LastUpdate last_update{stage, "0.2.0", "B", "boot", "why"};
    const auto result = read<LastUpdate>(write(last_update));
    ASSERT_TRUE(result) << result.error();
    EXPECT_EQ(*result, last_update);
  }
}

/// Each member left out, of another kind, twice over; and one that is none.
template <class Read>
void expect_strict(const std::string& text, Read read) {
  const json good = json::parse(text);
  for (const auto& [name, value] : good.items()) {
    for (const json& wrong : {json(), json(R"([["x"]])"_json)}) {
      json bad = good;
      if (wrong.is_null()) {
        bad.erase(name);
      } else {
        bad[name] = wrong;
      }
      const bool may_lack = wrong.is_null() && (name == "progress" || name == "stick");
      const auto outcome = read(bad.dump());
      EXPECT_EQ(outcome.has_value(), may_lack) << name;
      if (outcome) continue;
      EXPECT_THAT(outcome.error(), HasSubstr(name));
    }
  }
  json more = good;
  more["more"] = 1;
  EXPECT_THAT(read(more.dump()).error(), HasSubstr("more"));
  for (const char* none : {"", "{", "[]", "null", "7"}) EXPECT_FALSE(read(none)) << none;
}

TEST(Messages, AreReadStrictly) {
  expect_strict(write(Request{kNonce, Request::What::Install, false}), read<Request>);
  expect_strict(write(a_status()), read<Status>);
  expect_strict(write(a_status().last), read<LastUpdate>);
}

TEST(Messages, OfAnotherFormatOrWithAnotherWordAreRefused) {
  json request = json::parse(write(Request{kNonce, Request::What::Install, false}));
  request["format"] = 2;
  EXPECT_FALSE(read<Request>(request.dump()));
  request["format"] = 1;
  request["what"] = "erase";
  EXPECT_THAT(read<Request>(request.dump()).error(), HasSubstr("install, stick, restart, back or stay"));
  request["what"] = "stick";
  for (const char* nonce :
       {"", "0123", "0123456789ABCDEF0123456789abcdef", "../../../../etc/passwd0000000000"}) {
    request["nonce"] = nonce;
    EXPECT_THAT(read<Request>(request.dump()).error(), HasSubstr("hexadecimal")) << nonce;
  }
  json status = json::parse(write(a_status()));
  for (const int percent : {-1, 101}) {
    status["progress"] = percent;
    EXPECT_FALSE(read<Status>(status.dump())) << percent;
  }
  status = json::parse(write(a_status()));
  status["last"]["stage"] = "lost";
  EXPECT_THAT(read<Status>(status.dump()).error(), HasSubstr("last.stage"));
  status = json::parse(write(a_status()));
  status["running"]["more"] = "x";
  EXPECT_THAT(read<Status>(status.dump()).error(), HasSubstr("running"));
}

}  // namespace
}  // namespace adit::update
