#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/run_adit.hpp"
#include "cli/view.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kFile =
    R"({"version":1,"command_post":{"scoring":{"address":"10.100.1.200","port":8000},)"
    R"("mapping":{"address":"10.100.1.201","port":8000}},)"
    R"("team":{"listen":[{"address":"10.0.0.1","port":8000}]},"robots":[{"name":"ugv1"}]})";

std::string shown(const std::string& trouble = "") {
  return setup_json(kFile, trouble);
}

constexpr const char* kNone = R"({"errors":[],"changes":[],"warnings":[]})";
constexpr const char* kChanges =
    R"({"errors":[],"changes":[{"path":"team.listen[0].port","from":8000,"to":8080}],)"
    R"("warnings":["Adit and this page move"]})";

class SettingsCommand : public testing::Test {
 public:
  ~SettingsCommand() override { std::filesystem::remove(settings_); }

 protected:
  SettingsCommand() {
    close(mkstemp(settings_.data()));
    std::ofstream(settings_) << kFile;
  }

  std::string settings_ = "/tmp/adit-settings-XXXXXX";
};

TEST_F(SettingsCommand, ShowsChangedSettingsAndWhichTokensAreSet) {
  const Server server({{"GET /adit/settings", Server::ok(shown())}});
  const Outcome outcome = run_adit(server, {"settings"});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_THAT(outcome.out, HasSubstr("saved on this box\n"));
  EXPECT_THAT(outcome.out, HasSubstr("command_post.scoring.address  10.100.1.200\n"));
  EXPECT_THAT(outcome.out, HasSubstr("robots[ugv1].name             ugv1\n"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("budget_mbit")));
  EXPECT_THAT(outcome.out, HasSubstr("tokens\n  scoring  set\n  team     not set\n"));
  EXPECT_EQ(run_adit(server, {"settings", "show", "--json"}).out, shown() + "\n");
}

TEST_F(SettingsCommand, ExportsTheFileByteForByte) {
  const Server server({{"GET /adit/settings/export", Server::ok("{\n  \"version\": 1\n}\n")}});
  EXPECT_EQ(run_adit(server, {"settings", "export"}).out, "{\n  \"version\": 1\n}\n");
}

TEST_F(SettingsCommand, ChecksAFileWithoutChangingAnything) {
  const Server server({{"POST /adit/settings/check", Server::ok(kChanges)}});
  const Outcome outcome = run_adit(server, {"settings", "check", settings_});
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_EQ(outcome.out, "  team.listen[0].port  8000  -> 8080\nwarning: Adit and this page move\n");
  EXPECT_THAT(server.request(), HasSubstr(std::string(R"({"settings":)") + kFile + "}"));
}

TEST_F(SettingsCommand, AppliesAFileOnTheTagItRead) {
  const Server server({{"GET /adit/settings", Server::ok(shown())},
                       {"POST /adit/settings/check", Server::ok(kChanges)},
                       {"POST /adit/settings", Server::ok(kNone)}});
  const Outcome outcome = run_adit(server, {"settings", "apply", settings_});
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_EQ(outcome.out, "  team.listen[0].port  8000  -> 8080\nwarning: Adit and this page move\n");
  EXPECT_THAT(server.posted(), HasSubstr(R"("base":"0123456789abcdef"})"));
}

TEST_F(SettingsCommand, TellsWhyAnAcceptedChangeIsNotInUse) {
  const std::string reverted = shown("the last change was reverted: x");
  const Server server({{"GET /adit/settings", Server::ok(reverted)},
                       {"POST /adit/settings/check", Server::ok(kChanges)},
                       {"POST /adit/settings", Server::ok(kChanges)},
                       {"POST /adit/course", Server::ok(kChanges)}});
  for (const auto& words : {std::vector<std::string_view>{"settings", "apply", settings_}, {"course", "B"}}) {
    const Outcome outcome = run_adit(server, words);
    EXPECT_EQ(outcome.exit, Exit::Attention) << words[0];
    EXPECT_EQ(outcome.err, "adit: the last change was reverted: x\n") << words[0];
    EXPECT_EQ(outcome.out, "") << words[0];
  }
}

TEST_F(SettingsCommand, HidesEarlierTroubleIfNothingChanges) {
  const std::string earlier = shown("the last change was reverted: x");
  const Server server({{"GET /adit/settings", Server::ok(earlier)},
                       {"POST /adit/settings/check", Server::ok(kNone)},
                       {"POST /adit/settings", Server::ok(kNone)}});
  const Outcome outcome = run_adit(server, {"settings", "apply", settings_});
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_EQ(outcome.out, "no changes\n");
}

TEST_F(SettingsCommand, SetsOneKey) {
  const Server server({{"GET /adit/settings", Server::ok(shown())},
                       {"POST /adit/settings/check", Server::ok(kChanges)},
                       {"POST /adit/settings", Server::ok(kNone)}});
  const auto sent = [&](std::string_view key, std::string_view value) {
    const Outcome outcome = run_adit(server, {"settings", "set", key, value});
    EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
    EXPECT_EQ(outcome.out, "  team.listen[0].port  8000  -> 8080\nwarning: Adit and this page move\n");
    return server.posted();
  };
  const std::string number = sent("team.listen[0].port", "8080");
  EXPECT_THAT(number, HasSubstr(R"("listen":[{"address":"10.0.0.1","port":8080}])"));
  EXPECT_THAT(number, HasSubstr(R"("base":"0123456789abcdef"})"));
  EXPECT_THAT(sent("robots[ugv1].name", "17"), HasSubstr(R"("robots":[{"name":"17"}])"))
      << "the value is text";
  EXPECT_THAT(sent("robots[0].name", "\"b\""), HasSubstr(R"("robots":[{"name":"b"}])"));
  EXPECT_THAT(sent("team.listen", "[]"), HasSubstr(R"("listen":[])"));
  for (const std::string_view key :
       {"team.listne", "robots[ugv2].name", "robots[1].name", "[]", "version.x"}) {
    EXPECT_EQ(run_adit(server, {"settings", "set", key, "1"}).exit, Exit::Unable) << key;
    EXPECT_THAT(server.request(), HasSubstr("GET ")) << "a change was sent";
  }
}

TEST_F(SettingsCommand, NamesTheItemOfAListThatIsMissing) {
  const Server server({{"GET /adit/settings", Server::ok(shown())}});
  const auto error_of = [&server](const char* key) {
    return run_adit(server, {"settings", "set", key, "husky"}).err;
  };
  EXPECT_EQ(error_of("robots[ugv9].alias"), "adit: robots has no item ugv9: there are ugv1\n");
  EXPECT_EQ(error_of("team.listen[3].port"), "adit: team.listen has no item 3: there are 0 to 0\n");
  EXPECT_EQ(error_of("robots[ugv1].alais"), "adit: no such settings key: robots[ugv1].alais\n");
}

TEST_F(SettingsCommand, NamesEachErrorOfAFileAndAppliesNothing) {
  const Server server(
      {{"GET /adit/settings", Server::ok(shown())},
       {"POST /adit/settings/check",
        Server::ok(
            R"({"errors":[{"path":"a.b","what":"is wrong"},{"path":"","what":"too"}],"changes":[],"warnings":[]})")},
       {"POST /adit/settings", Server::ok(kNone)}});
  for (const std::string_view verb : {"check", "apply"}) {
    const Outcome outcome = run_adit(server, {"settings", verb, settings_});
    EXPECT_EQ(outcome.exit, Exit::Attention);
    EXPECT_EQ(outcome.err, "adit: line 1, column 1: a.b: is wrong\nadit: too\n");
    EXPECT_THAT(server.request(), HasSubstr("POST /adit/settings/check "))
        << "the check was not the last request";
  }
}

TEST_F(SettingsCommand, TellsThatTheSettingsChangedMeanwhile) {
  const Server server({{"GET /adit/settings", Server::ok(shown())},
                       {"POST /adit/settings/check", Server::ok(kChanges)},
                       {"POST /adit/settings", Server::reply("409 Conflict", "\"somebody else has\"")}});
  const Outcome outcome = run_adit(server, {"settings", "apply", settings_});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.err, "adit: somebody else has\n");
}

TEST_F(SettingsCommand, NamesTheFaultOfAnInvalidFile) {
  const Server server({{"POST /adit/settings/check", Server::ok(kChanges)}});
  EXPECT_EQ(run_adit(server, {"settings", "check", "/none.json"}).err,
            "adit: /none.json: No such file or directory\n");
  std::ofstream(settings_, std::ios::trunc) << "{";
  const Outcome outcome = run_adit(server, {"settings", "check", settings_});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_THAT(outcome.err, HasSubstr(settings_ + ": line 1, column 2: not well-formed JSON: "));
  EXPECT_EQ(server.request(), "");
}

TEST_F(SettingsCommand, ListsTheCourses) {
  constexpr const char* kPost =
      R"("command_post":{"scoring":{"address":"10.100.1.200","port":8000},"mapping":{"address":"10.100.1.201","port":8000},"course":"B"},)";
  constexpr const char* kCourses =
      R"([{"name":"B","scoring":{"address":"10.100.2.200","port":8000},"mapping":{"address":"10.100.2.201","port":8000}}])";
  const std::string settings = std::string(R"({"version":1,)") + kPost +
                               R"("team":{"listen":[{"address":"10.0.0.1","port":8000}]},"courses":)" +
                               kCourses + "}";
  const Server server({{"GET /adit/settings", Server::ok(setup_json(settings))}});
  const Outcome outcome = run_adit(server, {"course"});
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_EQ(outcome.out,
            "  course  scoring            mapping\n"
            "  B       10.100.2.200:8000  10.100.2.201:8000  in use\n"
            "  \"\"      10.100.1.200:8000  10.100.1.201:8000\n");
  EXPECT_EQ(run_adit(server, {"course", "--json"}).out,
            std::string(R"({"course":"B","courses":)") + kCourses + "}\n");
}

TEST_F(SettingsCommand, SwitchesTheCourse) {
  const Server server(
      {{"GET /adit/settings", Server::ok(shown())},
       {"POST /adit/course",
        Server::ok(R"({"changes":[],"warnings":["reports go to b:1 from then on; 2 reports wait"]})")}});
  EXPECT_EQ(run_adit(server, {"course", "B"}).out,
            "course B is in use\nwarning: reports go to b:1 from then on; 2 reports wait\n");
  EXPECT_THAT(server.posted(), HasSubstr(R"({"name":"B"})"));
  EXPECT_THAT(run_adit(server, {"course", ""}).out, HasSubstr("no course is in use"));
  EXPECT_THAT(server.posted(), HasSubstr(R"({"name":""})"));
  const Server other(
      {{"POST /adit/course",
        Server::reply("422 Unprocessable", "\"command_post.course: no course is called C\"")}});
  const Outcome outcome = run_adit(other, {"course", "C"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.err, "adit: command_post.course: no course is called C\n");
}

}  // namespace
}  // namespace adit::cli
