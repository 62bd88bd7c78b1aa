#include <gtest/gtest.h>

#include "host/folder.hpp"
#include "host/service.hpp"
#include "spool/kept_message.hpp"
#include "spool/no_file_above.hpp"

namespace adit::spool {
namespace {

class PartFileTest : public testing::Test {
 protected:
  std::vector<std::string> names() const { return host::names_in(folder_.path()).value(); }

  host::Folder folder_;
  const std::string path_ = folder_ / "map";
};

TEST_F(PartFileTest, HasItsNameOnlyOnceRenamed) {
  PartFile file(path_);
  icd::ChunkedBytes bytes;
  bytes.append(std::vector<std::uint8_t>(200'000, 'x'));
  EXPECT_EQ(file.append("--"), 0);
  EXPECT_EQ(file.append(bytes), 0);
  EXPECT_TRUE(bytes.empty());
  EXPECT_EQ(file.begin_with("ab"), 0);
  EXPECT_EQ(file.size(), 200'002u);
  ASSERT_EQ(names().size(), 1u);
  EXPECT_TRUE(names().front().ends_with(PartFile::kEnding));
  EXPECT_EQ(file.name(path_), 0);
  EXPECT_EQ(names(), std::vector<std::string>{"map"});
  EXPECT_EQ(host::read_file(path_), "ab" + std::string(200'000, 'x'));
}

TEST_F(PartFileTest, IsDeletedUnlessRenamed) {
  {
    PartFile file(path_), another(path_);
    EXPECT_EQ(file.append("half"), 0);
    EXPECT_EQ(names().size(), 2u) << "two of one name are two files";
  }
  EXPECT_TRUE(names().empty());
}

TEST_F(PartFileTest, KeepsUnwrittenBytesOnAFullDisk) {
  PartFile file(path_);
  icd::ChunkedBytes pieces;  // one chunk each
  for (const char c : {'a', 'b', 'c'}) {
    pieces.append(icd::ChunkedBytes(std::vector<std::uint8_t>(3000, static_cast<std::uint8_t>(c))));
  }
  const NoFileAbove small(4096);
  EXPECT_NE(file.append(pieces), 0);
  EXPECT_EQ(pieces.to_string(), std::string(3000, 'b') + std::string(3000, 'c'));
  EXPECT_EQ(file.size(), 3000u);
  EXPECT_EQ(file.append("d"), 0) << "in place of the leftover file";
  const MappedFile map = file.map().value();
  EXPECT_EQ(map.bytes[3000], 'd');
}

TEST_F(PartFileTest, TellsWhyItCannotBeCreated) {
  PartFile file(folder_ / "none/map");
  EXPECT_EQ(file.append("x"), ENOENT);
  EXPECT_EQ(file.name(path_), ENOENT);
}

TEST_F(PartFileTest, MappingOutlivesTheFile) {
  MappedFile map;
  {
    PartFile file(path_);
    EXPECT_TRUE(file.map().value().bytes.empty());
    EXPECT_EQ(file.append("abc"), 0);
    map = file.map().value();
  }
  EXPECT_TRUE(names().empty());
  EXPECT_EQ(std::string(map.bytes.begin(), map.bytes.end()), "abc");
  EXPECT_EQ(map_file(path_).error(), ENOENT);
}

}  // namespace
}  // namespace adit::spool
