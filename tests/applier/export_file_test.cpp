#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "applier/sticks.hpp"
#include "host/folder.hpp"
#include "spare/sealed.hpp"

namespace adit::applier {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kName = "adit-a-20261123T231600Z.adit-spare";

TEST(ExportFile, ReadsBackTheSame) {
  const host::Folder stick;
  ASSERT_TRUE(write_export(stick.path(), kName, "one"));
  ASSERT_TRUE(write_export(stick.path(), kName, "another")) << "a second export replaces the first";
  EXPECT_EQ(read_export(stick.path(), kName), "another");
  EXPECT_FALSE(fs::exists(stick / kUnfinished));
}

TEST(ExportFile, DeletesUnfinishedFilesOnly) {
  const host::Folder stick;
  stick.put("photo", "of a cave");
  stick.put(kUnfinished, "from the day when it was pulled out");
  ASSERT_TRUE(write_export(stick.path(), kName, "one"));
  EXPECT_FALSE(fs::exists(stick / kUnfinished));
  EXPECT_TRUE(fs::exists(stick / "photo"));
}

TEST(ExportFile, ReplacesNoDirectoryAndFollowsNoLink) {
  const host::Folder stick, elsewhere;
  fs::create_directory(stick / kName);
  EXPECT_FALSE(write_export(stick.path(), kName, "one"));
  EXPECT_FALSE(fs::exists(stick / kUnfinished)) << "the unfinished file is removed";
  fs::remove(stick / kName);
  fs::create_symlink(elsewhere / "target", stick / kName);
  fs::create_symlink(elsewhere / "other", stick / kUnfinished);
  ASSERT_TRUE(write_export(stick.path(), kName, "one"));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(stick / kName)));
  EXPECT_TRUE(fs::is_empty(elsewhere.path()));
}

TEST(ExportFile, IsARegularFileOfBoundedSize) {
  const host::Folder stick, elsewhere;
  const std::string secret = elsewhere.put("secret", "of the box");
  fs::create_symlink(secret, stick / "link.adit-spare");
  EXPECT_FALSE(read_export(stick.path(), "link.adit-spare"));
  ASSERT_EQ(mkfifo((stick / "pipe.adit-spare").c_str(), 0600), 0);
  EXPECT_THAT(read_export(stick.path(), "pipe.adit-spare").error(), HasSubstr("is not a regular file"));
  fs::create_directory(stick / "folder.adit-spare");
  EXPECT_FALSE(read_export(stick.path(), "folder.adit-spare"));
  EXPECT_FALSE(read_export(stick.path(), "none.adit-spare"));
  const std::string large = stick.put("large.adit-spare", "x");
  ASSERT_EQ(truncate(large.c_str(), spare::kLargestExport), 0);
  EXPECT_TRUE(read_export(stick.path(), "large.adit-spare"));
  ASSERT_EQ(truncate(large.c_str(), off_t{1} << 40), 0);
  EXPECT_THAT(read_export(stick.path(), "large.adit-spare").error(),
              HasSubstr("larger than an export may be"));
}

}  // namespace
}  // namespace adit::applier
