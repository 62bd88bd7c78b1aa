#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

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
  }
  ~ReadSecrets() override { unsetenv("CREDENTIALS_DIRECTORY"); }
  Folder folder_;
};

TEST_F(ReadSecrets, GivesEachTokenWithoutTheSpaceAroundIt) {
  const auto secrets = read_secrets(folder_.path());
  ASSERT_TRUE(secrets.has_value()) << secrets.error();
  EXPECT_EQ(secrets->scoring->reveal(), "flux230{showroom");
  EXPECT_EQ(secrets->mapping->reveal(), "mapping-token");
  EXPECT_EQ(secrets->team->reveal(), "team-token");
}

TEST_F(ReadSecrets, DoesWithoutATeamToken) {
  for (const std::string empty : {"", "\n"}) {  // systemd's stand-in for a credential that is not there
    folder_.put("team.token", empty);
    EXPECT_FALSE(read_secrets(folder_.path()).value().team.has_value());
  }
  std::filesystem::remove(folder_ / "team.token");
  EXPECT_FALSE(read_secrets(folder_.path()).value().team.has_value());
}

TEST_F(ReadSecrets, KnowsTheCodeOfTheLabelWhereThereIsOne) {
  EXPECT_FALSE(read_secrets(folder_.path()).value().label_code.has_value());
  folder_.put("label.code", "\n");  // systemd's stand-in
  EXPECT_FALSE(read_secrets(folder_.path()).value().label_code.has_value());
  folder_.put("label.code", "31415926\n");
  EXPECT_EQ(read_secrets(folder_.path()).value().label_code->reveal(), "31415926");
  for (const std::string wrong : {"3141592", "314159265", "3141592x"}) {
    folder_.put("label.code", wrong);
    EXPECT_EQ(read_secrets(folder_.path()).error(), (folder_ / "label.code") + ": expected 8 digits");
  }
}

TEST_F(ReadSecrets, NeedsBothTokensOfTheCommandPost) {
  for (const std::string name : {"scoring.token", "mapping.token"}) {
    const std::string path = folder_ / name;
    std::filesystem::rename(path, folder_ / "aside");
    EXPECT_EQ(read_secrets(folder_.path()).error(), path + ": there is no token");
    folder_.put(name, " \n");
    EXPECT_EQ(read_secrets(folder_.path()).error(), path + ": there is no token");
    std::filesystem::rename(folder_ / "aside", path);
  }
}

TEST_F(ReadSecrets, RefusesAFileThatOthersMayReadOrWrite) {
  for (const mode_t mode : {0640u, 0604u, 0620u, 0602u, 0644u}) {
    for (const std::string name : {"scoring.token", "mapping.token", "team.token"}) {
      chmod((folder_ / name).c_str(), mode);
      const auto secrets = read_secrets(folder_.path());
      ASSERT_FALSE(secrets.has_value()) << name << std::oct << mode;
      EXPECT_THAT(secrets.error(), HasSubstr("chmod 600 " + (folder_ / name)));
      chmod((folder_ / name).c_str(), 0600);
    }
  }
}

TEST_F(ReadSecrets, TrustsTheModesOfSystemdsCredentials) {
  chmod((folder_ / "scoring.token").c_str(), 0440);
  setenv("CREDENTIALS_DIRECTORY", folder_.path().c_str(), 1);
  EXPECT_TRUE(read_secrets(folder_.path()).has_value());
  EXPECT_TRUE(read_secrets(folder_.path() + "/").has_value());
  setenv("CREDENTIALS_DIRECTORY", "/run/credentials/another.service", 1);
  EXPECT_FALSE(read_secrets(folder_.path()).has_value());
}

TEST_F(ReadSecrets, NamesTheFileAndNeverWhatIsInIt) {
  for (const std::string& text :
       {std::string("secret one\nsecret two"), std::string(300, 's'), std::string("secret\0", 7),
        std::string("s\xc3\xa9"
                    "cret")}) {
    folder_.put("team.token", text);
    const auto secrets = read_secrets(folder_.path());
    ASSERT_FALSE(secrets.has_value()) << text;
    EXPECT_THAT(secrets.error(), HasSubstr(folder_ / "team.token"));
    EXPECT_THAT(secrets.error(), Not(HasSubstr("secret")));
    EXPECT_THAT(secrets.error(), Not(HasSubstr("sss")));
  }
}

TEST_F(ReadSecrets, SaysThatThereIsNoFolder) {
  EXPECT_THAT(read_secrets(folder_ / "none").error(), HasSubstr("scoring.token: there is no token"));
}

}  // namespace
}  // namespace adit::host
