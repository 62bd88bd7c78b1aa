#include "spare/medium.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace adit::spare {
namespace {

using testing::HasSubstr;

Medium stick(std::string name, std::string disk, std::uint64_t room) {
  return {.name = std::move(name), .disk = std::move(disk), .is_mounted = true, .room = room};
}

std::string chosen(const std::vector<Medium>& media, std::uint64_t size = 1000) {
  const auto medium = medium_for(media, size);
  return medium ? medium->name : medium.error();
}

TEST(Medium, IsTheOneStickThatIsIn) {
  EXPECT_EQ(chosen({stick("sda1", "sda", 1000)}), "sda1");
}

TEST(Medium, IsThePartitionWithTheMostRoom) {
  EXPECT_EQ(chosen({stick("sda1", "sda", 2000), stick("sda2", "sda", 3000), stick("sda3", "sda", 10)}),
            "sda2");
  const Medium unread{.name = "sda2", .disk = "sda"};
  EXPECT_EQ(chosen({unread, stick("sda1", "sda", 2000)}), "sda1") << "not one that cannot be read";
}

TEST(Medium, IsNoneWhereNobodyCouldSayWhichStickHasIt) {
  EXPECT_THAT(chosen({stick("sda1", "sda", 2000), stick("sdb1", "sdb", 3000)}),
              HasSubstr("more than one stick"));
}

TEST(Medium, IsNoneForAReasonThatIsSaid) {
  EXPECT_EQ(chosen({}), "there is no stick in the box");
  EXPECT_EQ(chosen({{.name = "sda1", .disk = "sda"}}),
            "the box cannot read the stick's file system: expected FAT32 or ext4");
  Medium locked = stick("sda1", "sda", 2000);
  locked.is_write_protected = true;
  EXPECT_EQ(chosen({locked}), "the stick is write-protected");
  EXPECT_EQ(chosen({stick("sda1", "sda", 999)}), "the stick has room for 999 bytes, but the export has 1000");
}

}  // namespace
}  // namespace adit::spare
