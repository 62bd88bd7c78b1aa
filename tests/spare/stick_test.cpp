#include "spare/stick.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace adit::spare {
namespace {

constexpr const char* kNonce = "0123456789abcdef0123456789abcdef";

TEST(StickMessages, ReadBackTheSame) {
  const StickRequest request{.nonce = kNonce, .what = StickRequest::Command::Write, .name = "a.adit-spare"};
  const auto read = codec::read_file<StickRequest>(codec::write_file(request));
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->what, StickRequest::Command::Write);
  EXPECT_EQ(read->name, "a.adit-spare");
  const StickStatus status{.nonce = kNonce,
                           .refusal = "no",
                           .doing = "writing",
                           .written = "a.adit-spare",
                           .hindrance = "there is no stick in the box",
                           .unreadable = "cannot read the stick sda1: Input/output error",
                           .exports = {"b.adit-spare", "a.adit-spare"}};
  EXPECT_EQ(codec::read_file<StickStatus>(codec::write_file(status)), status);
}

TEST(StickMessages, NameNothingOutsideTheStick) {
  for (const char* const name : {"../../etc/passwd", "/etc/shadow", "a/b.adit-spare", ".adit-spare", ""}) {
    const StickRequest request{.nonce = kNonce, .what = StickRequest::Command::Take, .name = name};
    EXPECT_FALSE(codec::read_file<StickRequest>(codec::write_file(request))) << name;
  }
  const StickRequest nameless{.nonce = "x", .what = StickRequest::Command::Take, .name = "a.adit-spare"};
  EXPECT_FALSE(codec::read_file<StickRequest>(codec::write_file(nameless)));
  EXPECT_FALSE(codec::read_file<StickRequest>(
      R"({"format":1,"nonce":"0123456789abcdef0123456789abcdef","what":"format","name":"a.adit-spare"})"));
}

using testing::HasSubstr;

Medium stick(std::string name, std::string disk, std::uint64_t room) {
  return {.name = std::move(name), .disk = std::move(disk), .is_mounted = true, .room = room};
}

std::string chosen(const std::vector<Medium>& media, std::uint64_t size = 1000) {
  const auto medium = medium_for(media, size);
  return medium ? medium->name : medium.error();
}

TEST(StickPartition, IsTheOnlyStick) {
  EXPECT_EQ(chosen({stick("sda1", "sda", 1000)}), "sda1");
}

TEST(StickPartition, IsThePartitionWithTheMostRoom) {
  EXPECT_EQ(chosen({stick("sda1", "sda", 2000), stick("sda2", "sda", 3000), stick("sda3", "sda", 10)}),
            "sda2");
  const Medium unread{.name = "sda2", .disk = "sda"};
  EXPECT_EQ(chosen({unread, stick("sda1", "sda", 2000)}), "sda1") << "not one that cannot be read";
}

TEST(StickPartition, IsNoneIfThereAreSeveralSticks) {
  EXPECT_THAT(chosen({stick("sda1", "sda", 2000), stick("sdb1", "sdb", 3000)}),
              HasSubstr("more than one stick"));
}

TEST(StickPartition, IsNoneWithAReason) {
  EXPECT_EQ(chosen({}), "there is no stick in the box");
  EXPECT_EQ(chosen({{.name = "sda1", .disk = "sda"}}),
            "the box cannot read the stick's file system: expected FAT32, exFAT or ext4");
  Medium locked = stick("sda1", "sda", 2000);
  locked.is_write_protected = true;
  EXPECT_EQ(chosen({locked}), "the stick is write-protected");
  EXPECT_EQ(chosen({stick("sda1", "sda", 999)}), "the stick has room for 999 bytes, but the export has 1000");
}

}  // namespace
}  // namespace adit::spare
