#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

using testing::HasSubstr;
using testing::Not;

class ReadSecrets : public testing::Test {
 protected:
  ReadSecrets() {
    folder_.put("scoring.token", "flux230{showroom\n");
    folder_.put("mapping.token", " mapping-token\r\n");
    folder_.put("team.token", "team-token");
    std::filesystem::create_directory(state_ / "secrets");
  }
  ~ReadSecrets() override { unsetenv("CREDENTIALS_DIRECTORY"); }
  std::expected<Secrets, std::string> read(const std::string& given) const {
    static const std::vector<std::string> kNames = {"scoring", "mapping", "team", "course.A.scoring"};
    return read_secrets(given, state_ / "secrets", kNames);
  }
  Folder folder_, state_;
};

TEST_F(ReadSecrets, TrimsEachToken) {
  const auto secrets = read(folder_.path());
  ASSERT_TRUE(secrets.has_value()) << secrets.error();
  EXPECT_EQ(secrets->token("scoring")->reveal(), "flux230{showroom");
  EXPECT_EQ(secrets->token("mapping")->reveal(), "mapping-token");
  EXPECT_EQ(secrets->token("team")->reveal(), "team-token");
}

TEST_F(ReadSecrets, AllowsAMissingTeamToken) {
  for (const std::string empty : {"", "\n"}) {  // systemd's placeholder for a missing credential
    folder_.put("team.token", empty);
    EXPECT_FALSE(read(folder_.path()).value().token("team").has_value());
  }
  std::filesystem::remove(folder_ / "team.token");
  EXPECT_FALSE(read(folder_.path()).value().token("team").has_value());
}

TEST_F(ReadSecrets, ReadsTheCodeOfTheLabelIfPresent) {
  EXPECT_FALSE(read(folder_.path()).value().label_code.has_value());
  folder_.put("label.code", "\n");  // systemd's placeholder
  EXPECT_FALSE(read(folder_.path()).value().label_code.has_value());
  folder_.put("label.code", "31415926\n");
  EXPECT_EQ(read(folder_.path()).value().label_code->reveal(), "31415926");
  for (const std::string wrong : {"3141592", "314159265", "3141592x"}) {
    folder_.put("label.code", wrong);
    EXPECT_EQ(read(folder_.path()).error(), (folder_ / "label.code") + ": expected 8 digits");
  }
}

TEST_F(ReadSecrets, AllowsNoTokens) {
  for (const std::string name : {"scoring", "mapping"}) {
    folder_.put(name + ".token", " \n");
    EXPECT_FALSE(read(folder_.path()).value().token(name).has_value());
    std::filesystem::remove(folder_ / (name + ".token"));
    EXPECT_FALSE(read(folder_.path()).value().token(name).has_value());
  }
  EXPECT_TRUE(read(folder_ / "none").value().tokens.empty()) << "no directory";
}

TEST_F(ReadSecrets, PrefersSavedToGivenTokens) {
  state_.put("secrets/scoring.token", "saved-one");
  state_.put("secrets/course.A.scoring.token", "of-course-a");
  state_.put("secrets/another.token", "nobody asks for it");
  const auto secrets = read(folder_.path());
  ASSERT_TRUE(secrets.has_value()) << secrets.error();
  EXPECT_EQ(secrets->token("scoring")->reveal(), "saved-one");
  EXPECT_EQ(secrets->token("mapping")->reveal(), "mapping-token");
  EXPECT_EQ(secrets->token("course.A.scoring")->reveal(), "of-course-a");
  EXPECT_EQ(secrets->tokens.size(), 4u);
  chmod((state_ / "secrets/scoring.token").c_str(), 0644);
  EXPECT_THAT(read(folder_.path())->damaged["scoring"],
              HasSubstr("chmod 600 " + (state_ / "secrets/scoring.token")));
}

/// As Windows' Notepad and PowerShell write them.
TEST_F(ReadSecrets, ReadsATokenInUnicode) {
  using namespace std::string_literals;
  for (const std::string& text : {"\xEF\xBB\xBFt{}1\r\n"s,
                                  "\xFF\xFEt\0{\0}\0"
                                  "1\0\r\0\n\0"s,
                                  "\xFE\xFF\0t\0{\0}\0"
                                  "1\0\r\0\n"s}) {
    folder_.put("scoring.token", text);
    const auto secrets = read(folder_.path());
    ASSERT_TRUE(secrets.has_value()) << secrets.error();
    EXPECT_EQ(secrets->token("scoring")->reveal(), "t{}1");
  }
  for (const std::string& text : {"\xFF\xFEt\0{"s, "\xFF\xFEt\0\xE4\x01"s, "\xEF\xBBt"s}) {
    folder_.put("scoring.token", text);
    EXPECT_FALSE(read(folder_.path()));
  }
}

TEST_F(ReadSecrets, ReplacesNoDamagedSavedToken) {
  state_.put("secrets/mapping.token", "saved-one");
  for (const char* const damaged : {"two words", "", " \n"}) {
    state_.put("secrets/scoring.token", damaged);
    const auto secrets = read(folder_.path());
    ASSERT_TRUE(secrets.has_value()) << secrets.error();
    EXPECT_FALSE(secrets->token("scoring")) << "the given one was replaced";
    EXPECT_EQ(secrets->token("mapping")->reveal(), "saved-one");
    EXPECT_EQ(secrets->token_warnings()["scoring"],
              "the saved token scoring is damaged; set it again: " + (state_ / "secrets/scoring.token") +
                  ": expected one token of 1 to 256 visible ASCII characters");
  }
}

TEST_F(ReadSecrets, TakesACopyOnlyOfADamagedToken) {
  ASSERT_TRUE(write_kept(state_ / "secrets/scoring.token", "saved-token\n"));
  const std::string file = state_ / "secrets/scoring.token", copy = file + kCopy;
  chmod(file.c_str(), 0644);
  EXPECT_THAT(read(folder_.path())->damaged["scoring"], HasSubstr("chmod 600 " + file));
  for (const char* const damaged : {"saved", "two words", ""}) {
    state_.put("secrets/scoring.token", damaged);
    chmod(file.c_str(), 0600);
    EXPECT_EQ(read(folder_.path())->token("scoring")->reveal(), "saved-token") << damaged;
  }
  state_.put("secrets/scoring.token", "edited-token\n");
  EXPECT_EQ(read(folder_.path())->token("scoring")->reveal(), "edited-token") << "by a person";
  std::filesystem::remove(copy);
  std::filesystem::create_directory(copy);
  state_.put("secrets/scoring.token", "two words");
  EXPECT_EQ(read(folder_.path())->unread, copy + ": is not a regular file");
}

TEST_F(ReadSecrets, ReplacesNoLostSavedToken) {
  state_.put("scoring.token.saved", "");
  const auto secrets = read(folder_.path());
  ASSERT_TRUE(secrets.has_value()) << secrets.error();
  EXPECT_FALSE(secrets->token("scoring")) << "the given one is valid again";
  EXPECT_EQ(secrets->token_warnings()["scoring"], "the saved token scoring is lost; set it again: " +
                                                      (state_ / "secrets/scoring.token") + " is gone");
  std::filesystem::remove(state_ / "secrets");
  EXPECT_FALSE(read(folder_.path())->token("scoring")) << "with its directory";
  EXPECT_TRUE(read(folder_.path())->token("mapping")) << "it was never saved";
}

TEST_F(ReadSecrets, ReportsAnUnreadableFileAndReadsTheOthers) {
  for (const std::string& path :
       {state_ / "secrets/team.token", state_ / "team.token.saved", folder_ / "label.code"}) {
    std::filesystem::create_directory(path);
    const auto secrets = read(folder_.path());
    ASSERT_TRUE(secrets.has_value()) << secrets.error();
    EXPECT_EQ(secrets->unread, path + ": is not a regular file");
    EXPECT_EQ(secrets->token("scoring")->reveal(), "flux230{showroom");
    std::filesystem::remove(path);
  }
}

TEST_F(ReadSecrets, RejectsAFileThatOthersMayAccess) {
  for (const mode_t mode : {0640u, 0604u, 0620u, 0602u, 0644u}) {
    for (const std::string name : {"scoring.token", "mapping.token", "team.token"}) {
      chmod((folder_ / name).c_str(), mode);
      const auto secrets = read(folder_.path());
      ASSERT_FALSE(secrets.has_value()) << name << std::oct << mode;
      EXPECT_THAT(secrets.error(), HasSubstr("chmod 600 " + (folder_ / name)));
      chmod((folder_ / name).c_str(), 0600);
    }
  }
}

TEST_F(ReadSecrets, TrustsTheModesOfSystemdCredentials) {
  chmod((folder_ / "scoring.token").c_str(), 0440);
  setenv("CREDENTIALS_DIRECTORY", folder_.path().c_str(), 1);
  EXPECT_TRUE(read(folder_.path()).has_value());
  EXPECT_TRUE(read(folder_.path() + "/").has_value());
  setenv("CREDENTIALS_DIRECTORY", "/run/credentials/another.service", 1);
  EXPECT_FALSE(read(folder_.path()).has_value());
}

TEST_F(ReadSecrets, NamesTheFileButNotItsContent) {
  for (const std::string& text :
       {std::string("secret one\nsecret two"), std::string(300, 's'), std::string("secret\0", 7),
        std::string("s\xc3\xa9"
                    "cret")}) {
    folder_.put("team.token", text);
    const auto secrets = read(folder_.path());
    ASSERT_FALSE(secrets.has_value()) << text;
    EXPECT_THAT(secrets.error(), HasSubstr(folder_ / "team.token"));
    EXPECT_THAT(secrets.error(), Not(HasSubstr("secret")));
    EXPECT_THAT(secrets.error(), Not(HasSubstr("sss")));
  }
}

}  // namespace
}  // namespace adit::host
