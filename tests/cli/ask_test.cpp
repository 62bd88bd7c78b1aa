#include "cli/ask.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "api/updates.hpp"
#include "cli/run_adit.hpp"
#include "cli/status_text.hpp"
#include "cli/view.hpp"
#include "host/folder.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

Outcome asked(const std::string& json, const std::vector<std::string_view>& words) {
  return run_adit(Server({{"GET /adit/run", Server::ok(json)},
                          {"GET /adit/update", Server::ok(codec::to_json(api::UpdateView{}))}}),
                  words);
}

/// Options of `adit status` with the environment of a box.
Options status_of_a_box() {
  return parse_options(std::vector<std::string_view>{"status"}).value();
}

TEST(Status, ShowsTheAnswerOfAdit) {
  const Outcome outcome = asked(codec::to_json(sample_view()), {"status"});
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_EQ(outcome.out, status_text(sample_view(), false));
}

TEST(Status, ReadsEachMemberOfTheApi) {
  api::RunView view = sample_view();
  view.refusals = {{.at = 998,
                    .uri = "/map/update",
                    .sender = "10.0.0.7",
                    .status = 422,
                    .sentence = "msg: expected an object"}};
  view.alarms = {
      {.id = "report_in_doubt:1", .severity = alarms::Severity::Ask, .what = "Report 1 is in doubt"}};
  view.alarms_over = {{.id = "robot_silent:r1", .was = "r1 was silent", .since = 1, .until = 2}};
  view.verdict = {facts::Level::Good, "Every map arrives", "1 robot, 2 s"};
  view.activities[0].queued = 2;
  view.activities[0].last_sentence = "Cloud updates too frequent. Reduce to <1Hz.";
  const Outcome outcome = asked(codec::to_json(view), {"status"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.out, status_text(view, false));
}

TEST(Status, ShowsTheFingerprintOfTheCertificate) {
  api::RunView view = sample_view();
  view.certificate = "AB:CD";
  EXPECT_THAT(asked(codec::to_json(view), {"status"}).out,
              HasSubstr("SHA-256 of the certificate is AB:CD\n"));
}

TEST(Status, NamesNewerVersions) {
  api::UpdateView update;
  update.newer = "0.2.0";
  update.status.stick = {"adit-a-board-0.3.0.raucb", "0.3.0"};
  Server::Answers answers{{"GET /adit/run", Server::ok(codec::to_json(sample_view()))},
                          {"GET /adit/update", Server::ok(codec::to_json(update))}};
  EXPECT_EQ(run_adit(Server(answers), {"status"}).out,
            status_text(sample_view(), false) +
                "On the stick is 0.3.0 (adit-a-board-0.3.0.raucb): "
                "adit update --stick\napt has 0.2.0: apt upgrade\n");
  answers["GET /adit/update"] = Server::reply("503 Service Unavailable", "\"not now\"");
  EXPECT_EQ(run_adit(Server(answers), {"status"}).out,
            status_text(sample_view(), false) + "cannot ask for newer versions: not now\n");
}

TEST(Status, IsFineIfAllAlarmsMayPass) {
  api::RunView view = sample_view();
  view.alarms = {{.id = "reports_left", .severity = alarms::Severity::Wait, .what = "5 reports are left"}};
  EXPECT_EQ(asked(codec::to_json(view), {"status"}).exit, Exit::Fine);
  view.alarms[0].severity = alarms::Severity::Bad;
  EXPECT_EQ(asked(codec::to_json(view), {"status"}).exit, Exit::Attention);
}

TEST(Status, GivesScriptsTheAnswerOfAdit) {
  const std::string json = codec::to_json(sample_view());
  EXPECT_EQ(asked(json, {"status", "--json"}).out, json + "\n");
}

TEST(Ask, RejectsAnAnswerOfAnotherProgram) {
  for (const std::string answer : {"", "hello", "[]", "{}", R"({"now": "noon"})"}) {
    const Outcome outcome = asked(answer, {"status"});
    EXPECT_EQ(outcome.exit, Exit::Unable) << answer;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr("cannot read the answer of Adit at 127.0.0.1:")) << answer;
  }
}

TEST(Ask, PassesOnTheSentenceOfAnError) {
  const auto status_of = [](const std::string& reply) { return run_adit(Server(reply), {"status"}).err; };
  EXPECT_THAT(status_of(Server::reply("404 Not Found", "{}")),
              HasSubstr("is not Adit, or is another version (HTTP status 404)"));
  EXPECT_EQ(status_of(Server::reply("503 Service Unavailable", "\"the ledger is away\\u001b[2J\"")),
            "adit: the ledger is away\\x1b[2J\n");
  EXPECT_THAT(status_of(Server::reply("401 Unauthorized", "\"log in\"")),
              HasSubstr("adit: Adit rejects the token in /"));
}

TEST(Ask, WithoutATokenExplainsHowToNameOne) {
  const Server server(Server::ok(codec::to_json(sample_view())));
  Options options = status_of_a_box();
  options.at = server.at();
  options.secrets = "/nowhere";
  options.saved_secrets = "/nothing";
  const Outcome outcome = run(options, {});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(
      outcome.err,
      "adit: cannot read a token in /nothing or /nowhere: set the team's token on the page, run adit as "
      "root, name a token file by --token-file FILE, or save the token once by adit login\n");
  EXPECT_EQ(server.request(), "");
}

TEST(Ask, PrefersTheAddressInSavedSettings) {
  const Server server(Server::ok(codec::to_json(sample_view())));
  const TokenFile token;
  char saved[] = "/tmp/adit-saved-XXXXXX";
  close(mkstemp(saved));
  const std::string port = std::to_string(server.address().port);
  std::ofstream(saved) << R"({"version": 1, "command_post": {"scoring": {"address": "::1", "port": 1},)"
                       << R"("mapping": {"address": "::1", "port": 2}},)"
                       << R"("team": {"listen": [{"address": "127.0.0.1", "port": )" << port << "}]}}";
  Options options = status_of_a_box();
  options.token_file = token.path();
  options.saved_settings = saved;
  EXPECT_NE(run(options, {}).exit, Exit::Unable);
  options.settings = "/none.json";
  EXPECT_EQ(run(options, {}).exit, Exit::Unable) << "a named file must exist";
  std::filesystem::remove(saved);
}

TEST(Ask, FailsIfSavedSettingsAreUnreadable) {
  const TokenFile token;
  const host::Folder folder;
  Options options = status_of_a_box();
  options.token_file = token.path();
  options.saved_settings = folder / "settings.json";
  std::filesystem::create_directory(options.saved_settings);
  const Outcome outcome = run(options, {});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_THAT(outcome.err, HasSubstr(options.saved_settings))
      << "the given settings may have another address";
}

/// An environment variable for one test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

TEST(Ask, ReadsAddressAndTokenFromTheEnvironment) {
  const Server server(Server::ok(codec::to_json(sample_view())));
  const TokenFile token;
  const std::string at = server.at(), file = token.path();
  const auto exit_of = [](const std::vector<std::string_view>& words) { return run(words).exit; };
  {
    const Variable address("ADIT_AT", at), named("ADIT_TOKEN_FILE", file);
    EXPECT_EQ(exit_of({"status"}), Exit::Fine);
    EXPECT_THAT(run(std::vector<std::string_view>{"status", "--settings", "/none.json"}).err,
                HasSubstr("/none.json"))
        << "a named file has priority";
  }
  const Variable address("ADIT_AT", "no where"), named("ADIT_TOKEN_FILE", "/none");
  EXPECT_EQ(exit_of({"status", "--at", at, "--token-file", file}), Exit::Fine) << "options have priority";
  EXPECT_THAT(run(std::vector<std::string_view>{"status"}).err,
              HasSubstr("adit: ADIT_AT: expected an address"));
  EXPECT_EQ(run(std::vector<std::string_view>{"status", "--at", at}).err,
            "adit: /none: No such file or directory\n");
}

TEST(Ask, TellsThatTheAddressIsUnknown) {
  const Outcome outcome = run(std::vector<std::string_view>{"status", "--settings", "/none.json"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(outcome.err,
            "adit: /none.json: No such file or directory; give Adit's address by --at ADDR[:PORT]\n");
  EXPECT_EQ(run(std::vector<std::string_view>{"status", "--at", "nowhere"}).exit, Exit::Unable);
}

}  // namespace
}  // namespace adit::cli
