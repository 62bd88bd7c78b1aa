#include "host/untrusted_folder.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

using testing::HasSubstr;

class UntrustedFolderTest : public testing::Test {
 protected:
  std::expected<std::optional<std::string>, UntrustedFolder::ReadFailure> take_file(const std::string& name) {
    auto opened = UntrustedFolder::open(folder.path());
    EXPECT_TRUE(opened);
    return opened->take_file(name);
  }
  bool is_there(const std::string& name) const {
    struct stat status{};
    return lstat((folder / name).c_str(), &status) == 0;
  }
  Folder folder;
};

TEST_F(UntrustedFolderTest, GivesAFileOnce) {
  folder.put("wanted.json", "{}");
  EXPECT_EQ(take_file("wanted.json").value(), "{}");
  EXPECT_FALSE(is_there("wanted.json"));
  EXPECT_EQ(take_file("wanted.json").value(), std::nullopt);
}

TEST_F(UntrustedFolderTest, FollowsNoLink) {
  folder.put("secret", "of root");
  ASSERT_EQ(symlink((folder / "secret").c_str(), (folder / "wanted.json").c_str()), 0);
  const auto taken = take_file("wanted.json");
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error().why, HasSubstr("wanted.json"));
  EXPECT_FALSE(is_there("wanted.json")) << "the request must be removed, or it repeats";
  EXPECT_TRUE(is_there("secret"));
}

TEST_F(UntrustedFolderTest, RejectsFifosAndDirectories) {
  ASSERT_EQ(mkfifo((folder / "wanted.json").c_str(), 0600), 0);
  EXPECT_THAT(take_file("wanted.json").error().why, HasSubstr("is not a regular file"));
  EXPECT_FALSE(is_there("wanted.json"));
  ASSERT_EQ(mkdir((folder / "wanted.json").c_str(), 0700), 0);
  EXPECT_FALSE(take_file("wanted.json"));
  EXPECT_FALSE(is_there("wanted.json"));
}

TEST_F(UntrustedFolderTest, DeletesADirectoryWithoutFollowingLinks) {
  folder.put("secret", "of root");
  ASSERT_EQ(mkdir((folder / "wanted.json").c_str(), 0700), 0);
  ASSERT_EQ(mkdir((folder / "wanted.json/deeper").c_str(), 0700), 0);
  folder.put("wanted.json/deeper/file", "x");
  ASSERT_EQ(symlink((folder / "secret").c_str(), (folder / "wanted.json/link").c_str()), 0);
  ASSERT_EQ(symlink(folder.path().c_str(), (folder / "wanted.json/deeper/all").c_str()), 0);
  EXPECT_FALSE(take_file("wanted.json"));
  EXPECT_FALSE(is_there("wanted.json"));
  EXPECT_TRUE(is_there("secret"));
}

TEST_F(UntrustedFolderTest, RenamesADirectoryTooDeepToDelete) {
  int deepest = open(folder.path().c_str(), O_RDONLY | O_DIRECTORY), levels = 0;
  for (const char* name = "wanted.json"; deepest >= 0 && levels < 300; ++levels, name = "d") {
    ASSERT_EQ(mkdirat(deepest, name, 0700), 0);
    const int deeper = openat(deepest, name, O_RDONLY | O_DIRECTORY);
    close(deepest);
    deepest = deeper;
  }
  close(deepest);
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const rlimit few{.rlim_cur = 256, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &few);
  const auto taken = take_file("wanted.json");
  setrlimit(RLIMIT_NOFILE, &before);
  ASSERT_FALSE(taken);
  EXPECT_FALSE(taken.error().stays);
  EXPECT_FALSE(is_there("wanted.json")) << "the request must be removed, or it repeats";
  EXPECT_EQ(take_file("wanted.json").value(), std::nullopt);
}

TEST_F(UntrustedFolderTest, ReportsANameThatStays) {
  ASSERT_EQ(mkdir((folder / "wanted.json").c_str(), 0700), 0);
  const pid_t child = fork();
  if (child == 0) {  // a mount point cannot be removed
    const int own = geteuid() == 0 ? CLONE_NEWNS : CLONE_NEWUSER | CLONE_NEWNS;
    const bool mounted = unshare(own) == 0 && mount("", "/", "", MS_REC | MS_PRIVATE, "") == 0 &&
                         mount("none", (folder / "wanted.json").c_str(), "tmpfs", 0, "") == 0;
    const auto taken = take_file("wanted.json");
    _exit(!mounted ? 77 : !taken && taken.error().stays && is_there("wanted.json") ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "needs to mount";
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(std::ranges::distance(std::filesystem::directory_iterator(folder.path())), 1)
      << "nothing beside it";
}

TEST_F(UntrustedFolderTest, LimitsTheSizeOfAFile) {
  folder.put("wanted.json", std::string(UntrustedFolder::kLargest, ' '));
  EXPECT_EQ(take_file("wanted.json").value()->size(), UntrustedFolder::kLargest);
  folder.put("wanted.json", std::string(UntrustedFolder::kLargest + 1, ' '));
  EXPECT_THAT(take_file("wanted.json").error().why, HasSubstr("large"));
  EXPECT_FALSE(is_there("wanted.json"));
}

TEST_F(UntrustedFolderTest, RejectsALinkAsItsDirectory) {
  ASSERT_EQ(symlink(folder.path().c_str(), (folder / "link").c_str()), 0);
  EXPECT_FALSE(UntrustedFolder::open(folder / "link"));
  EXPECT_FALSE(UntrustedFolder::open(folder / "none"));
}

TEST_F(UntrustedFolderTest, ReadsAFileWithoutDeletingIt) {
  folder.put("wanted.json", "{}");
  auto opened = UntrustedFolder::open(folder.path());
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->read("wanted.json").value(), "{}");
  EXPECT_EQ(opened->read("wanted.json").value(), "{}");
  EXPECT_EQ(opened->read("word.json").value(), std::nullopt);
  ASSERT_EQ(symlink((folder / "wanted.json").c_str(), (folder / "word.json").c_str()), 0);
  EXPECT_FALSE(opened->read("word.json"));
}

TEST_F(UntrustedFolderTest, OpensDirectoriesButNoLinks) {
  auto opened = UntrustedFolder::open(folder.path());
  ASSERT_TRUE(opened);
  EXPECT_FALSE(opened->folder("inside").value());
  ASSERT_EQ(mkdir((folder / "inside").c_str(), 0700), 0);
  EXPECT_TRUE(opened->folder("inside").value());
  ASSERT_EQ(symlink("/etc", (folder / "link").c_str()), 0);
  EXPECT_FALSE(opened->folder("link"));
}

TEST_F(UntrustedFolderTest, ListsALimitedNumberOfFilesInOrder) {
  auto opened = UntrustedFolder::open(folder.path());
  ASSERT_TRUE(opened);
  for (const char* name : {"b", "a"}) folder.put(name, "");
  EXPECT_EQ(opened->names().value(), (std::vector<std::string>{"a", "b"}));
  for (std::size_t i = 2; i < kMostNames; ++i) folder.put(std::to_string(i), "");
  EXPECT_EQ(opened->names().value().size(), kMostNames);
  folder.put("one more", "");
  EXPECT_THAT(opened->names().error(), HasSubstr("more than 256"));
}

TEST_F(UntrustedFolderTest, WipesOnlyAFile) {
  auto opened = UntrustedFolder::open(folder.path());
  ASSERT_TRUE(opened);
  folder.put("token", std::string(5000, 'x'));
  ASSERT_EQ(link((folder / "token").c_str(), (folder / "same").c_str()), 0);
  EXPECT_TRUE(opened->wipe("token"));
  EXPECT_FALSE(is_there("token"));
  EXPECT_EQ(opened->read("same").value(), std::string(5000, '\0'));
  EXPECT_FALSE(opened->wipe("token"));
  folder.put("of somebody else", "stays");
  ASSERT_EQ(symlink("of somebody else", (folder / "token").c_str()), 0);
  EXPECT_FALSE(opened->wipe("token"));
  EXPECT_EQ(opened->read("of somebody else").value(), "stays");
}

}  // namespace
}  // namespace adit::host
