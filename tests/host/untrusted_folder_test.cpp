#include "host/untrusted_folder.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/folder.hpp"

namespace adit::host {
namespace {

using testing::HasSubstr;

class UntrustedFolderTest : public testing::Test {
 protected:
  std::expected<std::optional<std::string>, std::string> take(const std::string& name) {
    const auto opened = UntrustedFolder::open(folder.path());
    EXPECT_TRUE(opened);
    return opened->take(name);
  }
  bool is_there(const std::string& name) const {
    struct stat status{};
    return lstat((folder / name).c_str(), &status) == 0;
  }
  Folder folder;
};

TEST_F(UntrustedFolderTest, GivesAFileOnce) {
  folder.put("wanted.json", "{}");
  EXPECT_EQ(take("wanted.json").value(), "{}");
  EXPECT_FALSE(is_there("wanted.json"));
  EXPECT_EQ(take("wanted.json").value(), std::nullopt);
}

TEST_F(UntrustedFolderTest, FollowsNoLink) {
  folder.put("secret", "of root");
  ASSERT_EQ(symlink((folder / "secret").c_str(), (folder / "wanted.json").c_str()), 0);
  const auto taken = take("wanted.json");
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error(), HasSubstr("wanted.json"));
  EXPECT_FALSE(is_there("wanted.json")) << "or it would be asked for again and again";
  EXPECT_TRUE(is_there("secret"));
}

TEST_F(UntrustedFolderTest, WaitsForNoFifoAndReadsNoFolder) {
  ASSERT_EQ(mkfifo((folder / "wanted.json").c_str(), 0600), 0);
  EXPECT_THAT(take("wanted.json").error(), HasSubstr("expected a plain file"));
  EXPECT_FALSE(is_there("wanted.json"));
  ASSERT_EQ(mkdir((folder / "wanted.json").c_str(), 0700), 0);
  EXPECT_FALSE(take("wanted.json"));
  EXPECT_FALSE(is_there("wanted.json"));
}

TEST_F(UntrustedFolderTest, TakesAFolderAwayWithAllThatIsInItAndFollowsNothingThere) {
  folder.put("secret", "of root");
  ASSERT_EQ(mkdir((folder / "wanted.json").c_str(), 0700), 0);
  ASSERT_EQ(mkdir((folder / "wanted.json/deeper").c_str(), 0700), 0);
  folder.put("wanted.json/deeper/file", "x");
  ASSERT_EQ(symlink((folder / "secret").c_str(), (folder / "wanted.json/link").c_str()), 0);
  ASSERT_EQ(symlink(folder.path().c_str(), (folder / "wanted.json/deeper/all").c_str()), 0);
  EXPECT_FALSE(take("wanted.json"));
  EXPECT_FALSE(is_there("wanted.json"));
  EXPECT_TRUE(is_there("secret"));
}

TEST_F(UntrustedFolderTest, ReadsOnlySoMuch) {
  folder.put("wanted.json", std::string(UntrustedFolder::kLargest, ' '));
  EXPECT_EQ(take("wanted.json").value()->size(), UntrustedFolder::kLargest);
  folder.put("wanted.json", std::string(UntrustedFolder::kLargest + 1, ' '));
  EXPECT_THAT(take("wanted.json").error(), HasSubstr("large"));
  EXPECT_FALSE(is_there("wanted.json"));
}

TEST_F(UntrustedFolderTest, IsNoLinkItself) {
  ASSERT_EQ(symlink(folder.path().c_str(), (folder / "link").c_str()), 0);
  EXPECT_FALSE(UntrustedFolder::open(folder / "link"));
  EXPECT_FALSE(UntrustedFolder::open(folder / "none"));
}

}  // namespace
}  // namespace adit::host
