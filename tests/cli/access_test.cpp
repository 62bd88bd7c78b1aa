#include <gmock/gmock.h>

#include <deque>

#include "cli/run_adit.hpp"

namespace adit::cli {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

/// A user who types `lines`, one after the other.
Console typing(std::deque<std::string> lines, std::string* asked = nullptr) {
  auto left = std::make_shared<std::deque<std::string>>(std::move(lines));
  return {.ask = [](const std::string&) { return std::optional(true); },
          .read_secret = [left, asked](const std::string& question) -> std::optional<std::string> {
            if (asked != nullptr) *asked += question;
            if (left->empty()) return std::nullopt;
            std::string line = left->front();
            left->pop_front();
            return line;
          }};
}

TEST(Tokens, AreTypedReadFromAFileOrRemoved) {
  const Server server({{"POST /adit/tokens", Server::ok(R"({"name":"mapping","set":true})")}});
  EXPECT_EQ(run_adit(server, {"tokens", "set", "mapping"}, typing({"sesame-7"})).out,
            "token mapping is set\n");
  EXPECT_THAT(server.posted(), EndsWith(R"({"name":"mapping","token":"sesame-7"})"));
  const TokenFile file("sesame-8");
  run_adit(server, {"tokens", "set", "team", file.path()});
  EXPECT_THAT(server.posted(), EndsWith(R"({"name":"team","token":"sesame-8"})"));
  EXPECT_EQ(run_adit(server, {"tokens", "remove", "team"}).out, "token team is removed\n");
  EXPECT_THAT(server.posted(), EndsWith(R"({"name":"team","token":null})"));
}

TEST(Tokens, WithOtherCharactersAreNotSent) {
  const Server server({{"POST /adit/tokens", Server::ok(R"({"name":"mapping","set":true})")}});
  const Outcome outcome = run_adit(server, {"tokens", "set", "mapping"}, typing({"two words"}));
  EXPECT_THAT(outcome.err, HasSubstr("visible ASCII"));
  EXPECT_EQ(server.posted(), "");
}

Server::Answers password_answers(bool first_start) {
  return {{"GET /adit/session", Server::ok(std::string(R"({"role":"operator","csrf":null,"first_start":)") +
                                           (first_start ? "true" : "false") + R"(,"set_up_open":false})")},
          {"POST /adit/password", Server::ok(R"({"role":"viewer"})")}};
}

TEST(Passwords, NeedTheOperatorsPresentOne) {
  const Server server(password_answers(false));
  std::string asked;
  const Outcome outcome = run_adit(server, {"password", "set", "viewer"},
                                   typing({"correct horse", "battery staple", "battery staple"}, &asked));
  EXPECT_EQ(outcome.out, "the password of the viewer is set; its sessions have ended\n") << outcome.err;
  EXPECT_EQ(asked, "the operator's present password: new password of the viewer: the new password again: ");
  EXPECT_THAT(server.posted(),
              EndsWith(R"({"role":"viewer","current":"correct horse","password":"battery staple"})"));
  run_adit(server, {"password", "remove"}, typing({"correct horse"}));
  EXPECT_THAT(server.posted(), EndsWith(R"({"role":"viewer","current":"correct horse","password":null})"));
}

TEST(Passwords, OfANewBoxNeedItsCode) {
  const Server server(password_answers(true));
  run_adit(server, {"password", "set"}, typing({"12345678", "battery staple", "battery staple"}));
  EXPECT_THAT(server.posted(),
              EndsWith(R"({"role":"operator","code":"12345678","password":"battery staple"})"));
}

TEST(Passwords, ThatDifferAreNotSent) {
  const Server server(password_answers(false));
  const Outcome outcome =
      run_adit(server, {"password", "set"}, typing({"correct horse", "battery staple", "batery staple"}));
  EXPECT_THAT(outcome.err, HasSubstr("the two new passwords differ"));
  EXPECT_THAT(run_adit(server, {"password", "set"}, typing({})).err,
              HasSubstr("present password is missing"));
  EXPECT_EQ(server.posted(), "");
}

TEST(Reset, NeedsAConfirmationAndThePassword) {
  const Server server({{"POST /adit/reset", Server::ok(R"({"said":"done"})")}});
  EXPECT_EQ(run_adit(server, {"reset"}).exit, Exit::Attention) << "without a terminal";
  EXPECT_EQ(server.posted(), "");
  EXPECT_EQ(run_adit(server, {"reset"}, typing({"correct horse"})).out, "the box is reset\n");
  EXPECT_THAT(server.posted(), EndsWith(R"({"password":"correct horse"})"));
}

}  // namespace
}  // namespace adit::cli
