#include "loop/regular_file.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace adit::loop {
namespace {

class RegularFile : public testing::Test {
 protected:
  ~RegularFile() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_ = [] {
    std::string name = std::filesystem::temp_directory_path() / "adit-loop-XXXXXX";
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    return name;
  }();
};

TEST_F(RegularFile, RejectsOtherFilesWithoutBlocking) {
  std::ofstream(folder_ / "file") << "text";
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  const FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  (folder_ / "socket").string().copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  for (const int flags : {O_RDONLY, O_WRONLY | O_APPEND, O_RDWR}) {
    EXPECT_TRUE(open_regular(folder_ / "file", flags));
    for (const std::filesystem::path& other :
         {folder_, folder_ / "pipe", folder_ / "socket", std::filesystem::path("/dev/null")}) {
      EXPECT_FALSE(open_regular(other, flags)) << other;
      EXPECT_EQ(text_of(errno), "is not a regular file") << other;
    }
    EXPECT_FALSE(open_regular(folder_ / "none", flags));
    EXPECT_EQ(errno, ENOENT);
  }
}

TEST_F(RegularFile, IsReadUpToALimit) {
  std::ofstream(folder_ / "file") << std::string(100'000, 'x');
  const auto text = read_all(open_regular(folder_ / "file", O_RDONLY), 100'000);
  EXPECT_EQ(text, std::string(100'000, 'x'));
  EXPECT_LE(text->capacity(), 100'001) << "the memory grew in steps";
  EXPECT_EQ(read_all(open_regular(folder_ / "file", O_RDONLY), 99'999).error(), EFBIG);
}

TEST_F(RegularFile, IsReadToItsEndIfItsSizeIsUnknown) {
  std::ostringstream whole;
  whole << std::ifstream("/proc/self/limits").rdbuf();
  ASSERT_GT(whole.view().size(), 512u);
  EXPECT_EQ(read_all(open_regular("/proc/self/limits", O_RDONLY), 100'000), whole.str());
}

TEST_F(RegularFile, IsWrittenInPlaceOrReportsAnError) {
  std::ofstream(folder_ / "file") << std::string(100'000, 'x');
  EXPECT_EQ(write_all(open_regular(folder_ / "file", O_WRONLY).get(), "yz", 99'999), 0);
  const std::string text = read_all(open_regular(folder_ / "file", O_RDONLY), 200'000).value();
  EXPECT_EQ(text, std::string(99'999, 'x') + "yz");
  EXPECT_EQ(write_all(open_regular(folder_ / "file", O_RDONLY).get(), "z", 0), EBADF);
}

}  // namespace
}  // namespace adit::loop
