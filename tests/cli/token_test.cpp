#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "cli/options.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

class FindToken : public testing::Test {
 public:
  ~FindToken() override {
    for (const std::string& folder : folders_) std::filesystem::remove_all(folder);
  }

 protected:
  FindToken() {
    for (std::string& folder : folders_) {
      folder = (std::filesystem::temp_directory_path() / "adit-token-XXXXXX").string();
      if (mkdtemp(folder.data()) == nullptr) ADD_FAILURE() << folder;
    }
  }
  /// Writes one of the given files.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }
  /// The token that is found without a named file.
  std::string found() const {
    const auto token = find_token("", folders_);
    if (!token) return "error: " + token.error();
    return *token ? (*token)->token.reveal() : "none";
  }
  std::vector<std::string> folders_{2};  // of the saved files, and of the given files
  const std::string& folder_ = folders_[1];
};

TEST_F(FindToken, PrefersASavedTokenToTheGivenOne) {
  write("team.token", "given-1");
  std::ofstream(folders_[0] + "/scoring.token") << "saved-scoring";
  EXPECT_EQ(found(), "given-1") << "the team's token has priority";
  std::ofstream(folders_[0] + "/team.token") << "saved-team";
  EXPECT_EQ(found(), "saved-team");
}

TEST_F(FindToken, PrefersTheTeamToken) {
  EXPECT_EQ(found(), "none");
  write("scoring.token", "scoring-1\n");
  EXPECT_EQ(found(), "scoring-1");
  write("team.token", " \n");
  EXPECT_EQ(found(), "scoring-1") << "an empty file has no token";
  const std::string team = write("team.token", "team-1\n");
  EXPECT_EQ(found(), "team-1");
  EXPECT_EQ((*find_token("", folders_))->file, team);
}

TEST_F(FindToken, FailsAtAnEmptyOrUnreadableToken) {
  write("team.token", "given-1");
  const std::string saved = folders_[0] + "/team.token";
  std::ofstream(saved) << '\n';
  EXPECT_THAT(found(), testing::StartsWith("error: " + saved + ": expected one token"));
  std::filesystem::remove(saved);
  std::filesystem::create_directory(saved);
  EXPECT_THAT(found(), testing::StartsWith("error: " + saved + ": is not a regular file; "));
}

TEST_F(FindToken, ReadsTheNamedFile) {
  write("team.token", "team-1");
  const std::string mine = write("mine", "\tmine-1\r\n");
  EXPECT_EQ((*find_token(mine, folders_))->token.reveal(), "mine-1");
}

TEST_F(FindToken, NamesTheFileButNotItsContent) {
  const std::string two = write("two", "sesame one");
  const auto token = find_token(two, folders_);
  ASSERT_FALSE(token.has_value());
  EXPECT_THAT(token.error(), testing::StartsWith(two + ": "));
  EXPECT_THAT(token.error(), Not(HasSubstr("sesame")));
  EXPECT_EQ(find_token(folder_ + "/none", folders_).error(), folder_ + "/none: No such file or directory");
  write("team.token", "sesame one");
  EXPECT_THAT(found(), testing::AllOf(HasSubstr("team.token"), Not(HasSubstr("sesame"))));
}

}  // namespace
}  // namespace adit::cli
