#include "store/log.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "store/small_log.hpp"

namespace adit::store {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LogTest : public testing::Test {
 protected:
  void damage(const std::string& name, std::size_t at, std::size_t size) {
    std::string bytes = files_.at(name);
    bytes.replace(at, size, size, '\xFF');
    small_.write(name, bytes);
  }

  SmallLog small_;
  std::map<std::string, std::string> files_;
};

/// The format of 0.1.0 (firmware/doors/store/README.md).
TEST(Frame, HasTheseBytes) {
  const std::string bytes = to_bytes({5, 0x0102, 3, 0x0101, "adit"}, {8, 1}, 0x1122334455667788, 64);
  const std::string expected(
      "ADTL\x26\x7A\x4C\x97"
      "\4\0\0\0\5\0\0\0"
      "\2\1\0\0\0\0\0\0\3\0\0\0\0\0\0\0\1\1\0\0\0\0\0\0"
      "adit",
      44);
  EXPECT_EQ(bytes, expected);
}

TEST(Frame, IsValidOnlyInItsPlaceAndFile) {
  const std::string bytes =
      std::string(8, ' ') + to_bytes({.kind = 1, .sequence = 1, .body = "a"}, {8, 1}, 7, 8);
  EXPECT_TRUE(parse(bytes, 8, 7));
  EXPECT_FALSE(parse(bytes, 8, 6));
  EXPECT_FALSE(parse(bytes.substr(8), 0, 7));
  EXPECT_FALSE(parse(bytes.substr(0, bytes.size() - 1), 8, 7));
}

TEST_F(LogTest, ReadsBackEachKindAndBody) {
  {
    auto opened = small_.open();
    ASSERT_TRUE(opened.log.append(1, "", Durability::Now));
    ASSERT_TRUE(opened.log.append(kMustUnderstand | 3, std::string("\0x", 2), Durability::Soon));
    EXPECT_EQ(opened.log.append(1, std::string(kMostBody + 1, 'x'), Durability::Now).error().cause,
              Error::Cause::TooLong);
    ASSERT_TRUE(opened.log.append(2, std::string(5000, 'y'), Durability::Now));  // longer than a file
  }
  const auto opened = small_.open();
  ASSERT_EQ(opened.contents.items.size(), 3);
  const auto record = [&](std::size_t i) { return std::get<Record>(opened.contents.items[i]); };
  EXPECT_EQ(record(1).kind, kMustUnderstand | 3);
  EXPECT_EQ(record(1).body, std::string("\0x", 2));
  EXPECT_EQ(record(2).body.size(), 5000);
  EXPECT_EQ(record(2).sequence, 3);
  EXPECT_THAT(opened.contents.notes, IsEmpty());
}

TEST_F(LogTest, DroppedRecordsStayDropped) {
  small_.fill({"a"}, Durability::Now);
  small_.fill({"b", "c"}, Durability::Soon);
  files_ = small_.files();
  const std::string name = files_.begin()->first;
  damage(name, 2 * 1024, 1024);  // a power cut tore b and left c
  EXPECT_THAT(bodies(small_.open().contents), ElementsAre("a"));
  small_.fill({"d"}, Durability::Soon);
  EXPECT_THAT(bodies(small_.open().contents), ElementsAre("a", "d"));
}

TEST_F(LogTest, DamagedCopyIsReportedAndRewritten) {
  small_.fill({"a", "b"}, Durability::Now);
  files_ = small_.files();
  damage(files_.begin()->first, 1024, 10);
  {
    const auto opened = small_.open();
    EXPECT_THAT(bodies(opened.contents), ElementsAre("a", "b"));
    EXPECT_THAT(opened.contents.notes, ElementsAre(HasSubstr("a damaged copy of record 1")));
  }
  EXPECT_EQ(small_.files(), files_);
}

/// A kill or a power cut tore the copy. No later record exists.
TEST_F(LogTest, TornCopyOfTheLastRecordIsNoDamage) {
  small_.fill({"a", "b"}, Durability::Now);
  files_ = small_.files();
  damage(files_.begin()->first, 2 * 1024 + 512, 512);
  const auto opened = small_.open();
  EXPECT_THAT(bodies(opened.contents), ElementsAre("a", "b"));
  EXPECT_THAT(opened.contents.notes, IsEmpty());
}

/// A start writes into the file, and may be killed before a snapshot replaces the rest.
TEST_F(LogTest, TruncatedFileIsReportedAtEachStart) {
  small_.fill({"a"}, Durability::Now);
  for (const std::size_t size : {0, 700, 2048}) {
    files_ = small_.files();
    small_.write(files_.begin()->first, files_.begin()->second.substr(0, size));
    EXPECT_TRUE(has_gap(small_.open().contents)) << size;
    EXPECT_TRUE(has_gap(small_.open().contents)) << size;
    small_.write(files_.begin()->first, files_.begin()->second);
  }
}

TEST_F(LogTest, ReadsAFileOfAnAbsurdSizeUpToItsEnd) {
  for (const LogOptions& keeping :
       {LogOptions{{512, 2}, 8192, true, 1u << 20}, LogOptions{kInMemory, 0, false, 1u << 20}}) {
    const SmallLog made(keeping);
    made.fill({"a", "b"}, Durability::Now);
    made.snapshot({"ab"});
    made.fill({"c"}, Durability::Now);
    const std::size_t count = made.files().size();
    for (const auto& [name, bytes] : made.files())
      fs::resize_file(made.path() + '/' + name, std::uintmax_t{1} << 40);
    const auto read = made.read().value();
    EXPECT_EQ(bodies(read), (std::vector<std::string>{"ab", "c"}));
    EXPECT_FALSE(has_gap(read));
    ASSERT_FALSE(read.notes.empty());
    EXPECT_LE(read.notes.size(), count);
    EXPECT_THAT(read.notes.back(), testing::HasSubstr(": it has 1099511627776 bytes, expected at most "));
    auto next = made.open();
    ASSERT_TRUE(next.log.append(1, "d", Durability::Now));
    EXPECT_EQ(bodies(made.read().value()), (std::vector<std::string>{"ab", "c", "d"}));
  }
}

TEST_F(LogTest, TurnsAFileThatGrowsBeforeItIsTooLongToBeRead) {
  const SmallLog made(LogOptions{kInMemory, 0, false, 4096});
  const std::vector<std::string> all(10, std::string(1000, 'x'));
  made.fill(all, Durability::Now);
  EXPECT_EQ(bodies(made.read().value()), all);
  EXPECT_GT(made.files().size(), 2u);
}

TEST_F(LogTest, NamesNoSnapshotThatIsTooLongToBeRead) {
  const SmallLog made(LogOptions{{512, 2}, 8192, true, 8192});
  made.fill({"a"}, Durability::Now);
  auto opened = made.open();
  ASSERT_TRUE(opened.log.turn());
  auto snapshot = Snapshot::begin(opened.directory, made.keeping, opened.log).value();
  const auto added = snapshot.add(1, std::string(5000, 'x'));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().what, "a snapshot of more than 8192 bytes");
  EXPECT_EQ(bodies(made.read().value()), std::vector<std::string>{"a"});
}

TEST_F(LogTest, ReadsAllLogsIfTheFirstSnapshotIsDamaged) {
  small_.fill({"a"}, Durability::Now);
  small_.snapshot({"A"});
  small_.fill({"b"}, Durability::Now);
  EXPECT_TRUE(small_.read()->has(1) && small_.read()->has(2));
  EXPECT_FALSE(small_.read()->has(3));
  files_ = small_.files();
  damage(files_.rbegin()->first, 0, files_.rbegin()->second.size());
  const auto opened = small_.open();
  EXPECT_THAT(bodies(opened.contents), ElementsAre("a", "b"));
  EXPECT_THAT(opened.contents.notes, ElementsAre(HasSubstr("a damaged snapshot")));
}

TEST_F(LogTest, UsesThePreviousSnapshotIfTheLastIsDamaged) {
  small_.fill({"a"}, Durability::Now);
  small_.snapshot({"A"});
  small_.fill({"b"}, Durability::Now);
  small_.snapshot({"A", "B"});
  small_.fill({"c"}, Durability::Now);
  EXPECT_THAT(bodies(small_.open().contents), ElementsAre("A", "B", "c"));
  files_ = small_.files();
  ASSERT_EQ(files_.size(), 4);  // two logs, two snapshots: the first log was removed
  damage(files_.rbegin()->first, 0, files_.rbegin()->second.size());
  const auto opened = small_.open();
  EXPECT_THAT(bodies(opened.contents), ElementsAre("A", "b", "c"));
  EXPECT_THAT(opened.contents.notes, ElementsAre(HasSubstr("a damaged snapshot")));
}

TEST_F(LogTest, SpareFileIsTheNextOne) {
  small_.fill({"a"}, Durability::Now);
  ASSERT_TRUE(make_spare(small_.open().directory, small_.keeping, false));
  std::string spare;
  for (const auto& [name, bytes] : small_.files()) {
    if (name.starts_with("spare-")) spare = name.substr(name.find('.'));
  }
  auto opened = small_.open();
  ASSERT_TRUE(opened.log.turn());
  EXPECT_THAT(small_.files().rbegin()->first,
              testing::AllOf(testing::StartsWith("log-00000002"), testing::EndsWith(spare)));
}

TEST_F(LogTest, UnreadableFileIsAnErrorAndIsKept) {
  small_.fill({"a"}, Durability::Now);
  files_ = small_.files();
  const std::string name = files_.begin()->first, path = small_.path() + '/' + name;
  std::filesystem::rename(path, small_.path() + "/elsewhere");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_THAT(small_.read().error().what, HasSubstr("not a regular file"));
  std::filesystem::remove(path);
  std::filesystem::create_symlink("elsewhere", path);
  EXPECT_FALSE(small_.read());
  std::filesystem::remove_all(small_.path());
  EXPECT_THAT(Directory::open(small_.path()).error().what, HasSubstr("No such file"));
}

TEST_F(LogTest, FileOfALaterVersionIsKept) {
  small_.fill({"a"}, Durability::Now);
  files_ = small_.files();
  const std::string name = files_.begin()->first;
  const FileName file{FileName::Kind::Log, 1, std::stoull(name.substr(name.find('.') + 1), nullptr, 16)};
  const std::string body = FileHeader{.version = 2, .number = 1, .salt = file.salt, .size = 8192}.to_bytes();
  std::string bytes = files_.at(name);
  bytes.replace(0, 1024,
                to_bytes({.kind = kFileBegins, .process = 1, .body = body}, kSmall.layout, file.salt, 0)
                    .append(1024, '\0'),
                0, 1024);
  small_.write(name, bytes);
  EXPECT_EQ(small_.read().error().cause, Error::Cause::Newer);
}

TEST_F(LogTest, IsWrittenByOneProcessAtATime) {
  const auto opened = small_.open();
  EXPECT_EQ(Directory::lock(small_.path()).error().cause, Error::Cause::InUse);
  EXPECT_TRUE(Directory::open(small_.path()));
}

/// A peer that knows the format cannot insert a record into the log with its message.
TEST_F(LogTest, FrameInsideARecordIsIgnored) {
  const std::string forged =
      to_bytes({.kind = 1, .sequence = 9, .process = 99, .body = "forged"}, kSmall.layout, 0, 2048);
  small_.fill({std::string(472, 'x') + forged, "b"}, Durability::Now);
  files_ = small_.files();
  for (const std::size_t at : {1024, 1024 + 1536})
    damage(files_.begin()->first, at, 8), files_ = small_.files();
  const auto opened = small_.open();
  EXPECT_THAT(bodies(opened.contents), ElementsAre("b"));
  EXPECT_EQ(std::get<Gap>(opened.contents.items.front()).last, 1);
}

}  // namespace
}  // namespace adit::store
