#include "host/disk.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <filesystem>

#include "host/folder.hpp"

namespace adit::host {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The kernel's tree for the disk of the test's directory: a disk, a partition in it, and links to both by
/// number.
class WearTest : public testing::Test {
 protected:
  WearTest() {
    for (const char* name : {"device", "disk/partition1", "block"}) fs::create_directories(folder_ / name);
    fs::create_symlink("../device", folder_ / "disk/device");
    folder_.put("disk/partition1/partition", "1\n");
    lies_on("../disk/partition1");
  }
  void lies_on(const std::string& device) {
    struct stat status{};
    ASSERT_EQ(stat(folder_.path().c_str(), &status), 0);
    const std::string number =
        std::to_string(major(status.st_dev)) + ":" + std::to_string(minor(status.st_dev));
    fs::remove(folder_ / ("block/" + number));
    fs::create_symlink(device, folder_ / ("block/" + number));
  }
  void reports(const std::string& life, const std::string& spares) {
    folder_.put("device/life_time", life);
    folder_.put("device/pre_eol_info", spares);
  }
  std::expected<Wear, std::string> wear() { return read_wear(folder_.path(), folder_ / "block"); }

  Folder folder_;
};

TEST_F(WearTest, IsThatOfTheEmmcOfThePartition) {
  reports("0x01 0x0a\n", "0x02\n");
  const auto found = wear();
  ASSERT_TRUE(found) << found.error();
  EXPECT_EQ(found->life, 10u) << "the higher estimate";
  EXPECT_EQ(found->spares, 2u);
}

TEST_F(WearTest, IsFoundWithoutAPartition) {
  reports("0x0b 0x00\n", "0x01\n");
  lies_on("../disk");
  const auto found = wear();
  ASSERT_TRUE(found) << found.error();
  EXPECT_EQ(found->life, 11u);
}

TEST_F(WearTest, IsZeroForCardsAndVirtualDisks) {
  const auto of_card = wear();
  ASSERT_TRUE(of_card) << of_card.error();
  EXPECT_EQ(of_card->life, 0u);
  fs::remove_all(folder_ / "block");
  EXPECT_TRUE(wear()) << "no disk: tmpfs, or a container";
}

TEST_F(WearTest, IsUnknownIfAFileIsUnreadableOrInvalid) {
  for (const char* life : {"", "\n", "0x01\n", "0x01 0x0c\n", "0x01 -1\n", "0x01 0x0a 0x01\n", "0x01 0x0a -",
                           "worn\n", "0x01 0x100000000\n"}) {
    reports(life, "0x01\n");
    ASSERT_FALSE(wear()) << life;
    EXPECT_THAT(wear().error(), HasSubstr("device/life_time: unknown value")) << life;
  }
  reports("0x01 0x01\n", "0x04\n");
  ASSERT_FALSE(wear());
  EXPECT_THAT(wear().error(), HasSubstr("pre_eol_info: unknown value \"0x04"));
  fs::remove(folder_ / "device/life_time");
  fs::create_directory(folder_ / "device/life_time");
  ASSERT_FALSE(wear());
  EXPECT_THAT(wear().error(), HasSubstr("life_time: is not a regular file"));
  EXPECT_FALSE(read_wear(folder_ / "absent", folder_ / "block"));
}

}  // namespace
}  // namespace adit::host
