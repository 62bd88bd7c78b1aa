#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "cli/commands.hpp"
#include "project_files.hpp"

namespace adit::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Check : public testing::Test {
 public:
  ~Check() override { std::filesystem::remove_all(folder_); }

 protected:
  Check() {
    std::string name = (std::filesystem::temp_directory_path() / "adit-check-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  Outcome check(const std::string& json, const std::vector<std::string_view>& more = {}) const {
    const std::string file = folder_ / "settings.json";
    std::ofstream(file) << json;
    std::vector<std::string_view> words = {"check", file};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  std::filesystem::path folder_;
};

constexpr const char* kWrong = R"({"version": 1,
  "command_post": {"scoring": {"adress": "10.100.1.200", "port": 99999},
                   "mapping": {"address": "10.100.1.201", "port": 8000}},
  "team": {"listen": [{"address": "0.0.0.0", "port": 8000}]}})";

TEST_F(Check, NamesEachErrorByItsPath) {
  const Outcome outcome = check(kWrong);
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(
      outcome.out,
      (folder_ / "settings.json").string() +
          ": 3 errors\n"
          "  line 2, column 32: command_post.scoring.adress: no such key; did you mean address? (keys here: "
          "address, port)\n"
          "  line 2, column 58: command_post.scoring.port: expected a whole number from 1 to 65535, got "
          "99999\n"
          "  line 2, column 20: command_post.scoring.address: missing; expected an IPv4 or IPv6 address\n");
}

TEST_F(Check, SummarizesGoodSettings) {
  const std::string example = project_file("firmware/rules/settings/example.json");
  const Outcome outcome = run(std::vector<std::string_view>{"check", example});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_EQ(outcome.out,
            example +
                ": correct\n"
                "  scoring  10.100.1.200:8000  on darpa0 only\n"
                "  mapping  10.100.1.201:8000  on darpa0 only\n"
                "  team     0.0.0.0:8000       on team0 only\n"
                "  link     100 Mbit/s\n"
                "  panel    gpiochip0          ADIT_HEALTH, ADIT_SCORING, ADIT_MAPPING, ADIT_ATTENTION, "
                "ADIT_BUTTON\n");
}

TEST_F(Check, GivesScriptsTheSameAsJson) {
  const Outcome wrong = check(R"({"version": 2})", {"--json"});
  EXPECT_EQ(wrong.exit, Exit::Attention);
  EXPECT_EQ(wrong.out,
            "{\"good\":false,\"errors\":[{\"path\":\"version\",\"what\":\"expected 1, got 2\",\"at\":\"line "
            "1, column 2\"}],"
            "\"warnings\":[]}\n");
  const std::string example = project_file("firmware/rules/settings/example.json");
  const Outcome good = run(std::vector<std::string_view>{"check", example, "--json"});
  EXPECT_EQ(good.exit, Exit::Fine);
  EXPECT_EQ(good.out, "{\"good\":true,\"errors\":[],\"warnings\":[]}\n");
}

constexpr const char* kGood = R"({"version": 1,
  "command_post": {"scoring": {"address": "10.100.1.200", "port": 8000},
                   "mapping": {"address": "10.99.1.201", "port": 8000}},
  "team": {"listen": [{"address": "TEAM", "port": 8000}]}})";

TEST_F(Check, WarnsOfOverlappingNetworks) {  // ICD 3
  const auto warnings = [this](const std::string& team, const std::string& more = "") {
    std::string json = kGood;
    json.replace(json.find("TEAM"), 4, team);
    json.insert(json.rfind('}'), more);
    const Outcome outcome = check(json);
    EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.out;
    const auto at = outcome.out.find("  warning: ");
    return at == std::string::npos ? "" : outcome.out.substr(at);
  };
  EXPECT_EQ(warnings("10.0.0.1"), "");
  EXPECT_EQ(warnings("0.0.0.0"), "");
  EXPECT_EQ(warnings("10.100.7.1"),
            "  warning: the team's network 10.100.7.1/32 overlaps 10.100.0.0/16 on the Command Post's side "
            "(ICD 3): "
            "choose another subnet for the team\n");
  EXPECT_THAT(warnings("10.100.7.1", R"(, "network": {"allow_overlap": true})"),
              HasSubstr("allowed, but a robot cannot reach both"));
}

TEST_F(Check, WarnsOfATokenWithoutSixteenCharacters) {  // ICD 4
  std::string json = kGood;
  json.replace(json.find("TEAM"), 4, "10.0.0.1");
  const std::string secrets = folder_ / "secrets";
  std::filesystem::create_directory(secrets);
  std::filesystem::permissions(secrets, std::filesystem::perms::owner_all);
  const auto keep = [&secrets](const std::string& name, const std::string& token) {
    const std::filesystem::path file = secrets + "/" + name + ".token";
    std::ofstream(file) << token << "\n";
    std::filesystem::permissions(file,
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  };
  keep("scoring", "flux230{showroom");
  keep("mapping", "flux230{showroo");
  keep("team", "any-length-at-all");
  Options options = parse_options(std::vector<std::string_view>{"check"}).value();
  options.settings = folder_ / "settings.json";
  std::ofstream(options.settings) << json;
  options.secrets = secrets;
  options.saved_secrets = folder_ / "none";
  options.json = true;
  const Outcome outcome = run(options, {});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_EQ(outcome.out,
            "{\"good\":true,\"errors\":[],\"warnings\":[\"the token mapping has 15 characters; the Command "
            "Post's tokens have 16 (ICD 4); is it complete?\"]}\n");
  std::filesystem::permissions(secrets + "/mapping.token", std::filesystem::perms::all);
  EXPECT_THAT(run(options, {}).out, HasSubstr("cannot check the tokens: " + secrets + "/mapping.token"));
}

TEST_F(Check, ReportsAnUnreadableFile) {
  const Outcome outcome = run(std::vector<std::string_view>{"check", "/none.json"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(outcome.err, "adit: /none.json: No such file or directory\n");
}

TEST_F(Check, EscapesTerminalSequences) {
  const Outcome outcome = check("{\"version\": 1, \"\x1b]0;owned\x07\": 1}");
  EXPECT_THAT(outcome.out, AllOf(Not(HasSubstr("\x1b")), HasSubstr("not well-formed JSON: ")));
}

}  // namespace
}  // namespace adit::cli
