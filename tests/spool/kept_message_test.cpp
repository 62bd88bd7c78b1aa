#include "spool/kept_message.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "codec/write.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"
#include "spool/messages.hpp"
#include "spool/no_file_above.hpp"

namespace adit::spool {
namespace {

namespace fs = std::filesystem;

icd::ChunkedBytes bytes(const std::string& text) {
  return icd::ChunkedBytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

class StoredMessageTest : public testing::Test {
 protected:
  host::Folder folder_;
  const std::string file_ = folder_ / "message.cbor";
};

TEST_F(StoredMessageTest, ReadsBackTheSame) {
  ASSERT_TRUE(replace_file(file_, codec::write_state_update(state())));
  EXPECT_EQ(read_state(file_), state());
  ASSERT_TRUE(replace_file(file_, codec::write_markers_update(markers())));
  EXPECT_EQ(read_markers(file_), markers());
  struct stat status{};
  ASSERT_EQ(::stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);
}

TEST_F(StoredMessageTest, KeepsTheOldFileOnAFullDisk) {
  ASSERT_TRUE(replace_file(file_, bytes("older")));
  const NoFileAbove small(4096);
  const auto written = replace_file(file_, codec::write_map_update(cloud(1000)));
  ASSERT_FALSE(written);
  EXPECT_TRUE(written.error().starts_with(file_ + ": ")) << written.error();
  EXPECT_EQ(host::read_file(file_), "older");
  EXPECT_EQ(host::names_in(folder_.path())->size(), 1u);
}

TEST_F(StoredMessageTest, LeavesNoFileIfItCannotBeRenamed) {
  fs::create_directory(file_);
  EXPECT_FALSE(replace_file(file_, bytes("newer")));
  EXPECT_EQ(host::names_in(folder_.path())->size(), 1u);
}

TEST_F(StoredMessageTest, PartialFilesAloneAreRemoved) {
  folder_.put("message.cbor.part", "half");
  folder_.put("message.cbor", "whole");
  remove_parts(folder_.path());
  EXPECT_EQ(host::names_in(folder_.path()), std::vector<std::string>{"message.cbor"});
  remove_parts(folder_ / "none");
}

TEST_F(StoredMessageTest, IsRejectedIfTruncatedOrOfAnotherKind) {
  const std::string whole = codec::write_state_update(state()).to_string();
  ASSERT_TRUE(replace_file(file_, bytes(whole.substr(0, whole.size() - 1))));
  EXPECT_FALSE(read_state(file_));
  ASSERT_TRUE(replace_file(file_, bytes(whole)));
  EXPECT_FALSE(read_map(file_));
  EXPECT_FALSE(read_markers(file_));
}

TEST_F(StoredMessageTest, UnreadableIsNotReportedAsDamaged) {
  EXPECT_EQ(read_state(folder_ / "none").error().status, icd::Status::UnprocessableEntity);
  fs::create_directory(file_);
  EXPECT_EQ(read_state(file_).error().status, icd::Status::ServiceUnavailable);
  EXPECT_EQ(read_map(file_).error().status, icd::Status::ServiceUnavailable);
}

TEST_F(StoredMessageTest, IsInAPrivateDirectory) {
  make_folder_of_ours(folder_ / "a/b");
  struct stat status{};
  ASSERT_EQ(::stat((folder_ / "a/b").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0700u);
}

}  // namespace
}  // namespace adit::spool
