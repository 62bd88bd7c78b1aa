#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "box/this_box.hpp"

namespace adit::box {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;
using testing::StartsWith;

class NoticesTest : public testing::Test {
 protected:
  NoticesTest() {
    std::string name = (std::filesystem::temp_directory_path() / "adit-notices-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~NoticesTest() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::filesystem::path folder_;
};

TEST_F(NoticesTest, AreTheFirstLinesOfFilesInOrder) {
  write("state", "the state partition is unusable\nand more\n");
  write("clock", "the clock has stopped");
  EXPECT_THAT(read_notices(folder_), ElementsAre(Pair("clock", "the clock has stopped"),
                                                 Pair("state", "the state partition is unusable")));
}

TEST_F(NoticesTest, AreEmptyWithoutFiles) {
  EXPECT_THAT(read_notices(folder_), IsEmpty());
  EXPECT_THAT(read_notices(folder_ / "absent"), IsEmpty());
}

TEST_F(NoticesTest, NameUnreadableFiles) {
  std::filesystem::create_directory(folder_ / "folder");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  write("empty", "");
  EXPECT_THAT(read_notices(folder_), ElementsAre(Pair("folder", StartsWith("cannot read ")),
                                                 Pair("pipe", StartsWith("cannot read "))));
  EXPECT_THAT(read_notices(folder_ / "empty"), ElementsAre(Pair("notices", StartsWith("cannot list "))));
}

TEST_F(NoticesTest, AreLimitedInNumberAndLength) {
  for (int i = 0; i < 20; ++i) write("notice" + std::to_string(i), std::string(10'000, 'x'));
  const auto notices = read_notices(folder_);
  EXPECT_THAT(notices, SizeIs(8));
  EXPECT_THAT(notices.begin()->second, SizeIs(500));
}

}  // namespace
}  // namespace adit::box
