#include "ledger/full_disk.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "ledger/folder.hpp"

namespace adit::ledger {
namespace {

using testing::ElementsAreArray;

/// Writes new reports until one fails, and gives its error; those that did not go to `reports`.
Error fill(Ledger& ledger, std::vector<dispatch::Report>& reports) {
  while (reports.size() < 10000) {
    const auto next = backpack(static_cast<std::int64_t>(reports.size()) + 1);
    const auto written = write(ledger, next);
    if (!written) return written.error();
    reports.push_back(next);
  }
  return Error{.what = "it never failed"};
}

TEST(FullDiskOfALedger, IsSaidAndEndsByItself) {
  const Folder folder;
  std::vector<dispatch::Report> reports;
  {
    auto ledger = open_or_fail(folder);
    {
      const FullDisk full(100000);
      const Error error = fill(ledger, reports);
      EXPECT_EQ(error.kind, Error::Kind::Full) << error.what;
      EXPECT_GT(reports.size(), 3u);
      EXPECT_FALSE(write(ledger, backpack(20000))) << "it is still full";
      dispatch::Report step = reports[0];
      step.answer.assign(50000, 'x');
      const auto written = write(ledger, step);
      ASSERT_FALSE(written);
      EXPECT_EQ(written.error().kind, Error::Kind::Full) << written.error().what;
      const auto heard = ledger.write(dispatch::Run{.number = 1});
      ASSERT_FALSE(heard);
      EXPECT_EQ(heard.error().kind, Error::Kind::Full) << heard.error().what;
      EXPECT_THAT(*ledger.reports(), ElementsAreArray(reports)) << "what was written can still be read";
    }
    reports.push_back(backpack(30000));
    ASSERT_TRUE(write(ledger, reports.back())) << "there is space again";
  }
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.damage(), "");
  EXPECT_THAT(*ledger.reports(), ElementsAreArray(reports));
  EXPECT_TRUE(ledger.runs()->empty());
}

TEST(FullDiskOfALedger, LeavesNothingHalfWritten) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(write(ledger, backpack(1)));
  dispatch::Report answered = backpack(1);
  answered.state = dispatch::ReportState::Answered;
  dispatch::Report large = backpack(2);
  large.answer.assign(300000, 'x');
  {
    const FullDisk full(100000);
    ASSERT_FALSE(ledger.write(std::vector{answered, large}));
  }
  EXPECT_THAT(*ledger.reports(), testing::ElementsAre(backpack(1)));
  EXPECT_EQ(ledger.history(1)->size(), 1u);
}

TEST(FullDiskOfALedger, DoesNotKeepItFromBeingOpened) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  {
    const FullDisk full(0);
    auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.reports()->size(), 1u);
    const auto written = write(ledger, backpack(2));
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, Error::Kind::Full) << written.error().what;
  }
  EXPECT_EQ(open_or_fail(folder).reports()->size(), 1u);
}

TEST(LedgerThatStandsIn, ShowsWhatCanBeReadAndTakesNothing) {
  const Folder folder, scratch;
  {
    auto first = open_or_fail(folder);  // what is in its log alone is read, too
    ASSERT_TRUE(write(first, backpack(1)));
    auto stands_in = Ledger::stand_in(folder.text(), scratch.text(), "it is read-only");
    ASSERT_TRUE(stands_in) << stands_in.error().what;
    EXPECT_THAT(*stands_in->reports(), testing::ElementsAre(backpack(1)));
    EXPECT_EQ(stands_in->history(1)->size(), 1u);
    EXPECT_EQ(stands_in->refusal(), "it is read-only");
    const auto written = write(*stands_in, backpack(2));
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().what, "it is read-only");
    EXPECT_EQ(first.reports()->size(), 1u);
  }
  EXPECT_TRUE(std::filesystem::is_empty(scratch.text())) << "it leaves nothing";
}

/// What a program that was killed has left: its folder, though nobody holds it any more.
std::filesystem::path left_by_a_dead_program(const Folder& scratch) {
  const auto live = Ledger::stand_in("/nowhere", scratch.text(), "for its name");
  const std::filesystem::path made = std::filesystem::directory_iterator(scratch.text())->path();
  const auto left = made.parent_path() /
                    (made.filename().string().substr(0, made.filename().string().size() - 6) + "killed");
  std::filesystem::copy(made, left);
  return left;
}

TEST(LedgerThatStandsIn, IsSweptAwayOnceItsProgramIsDeadAndNotBefore) {
  const Folder folder, scratch;
  const auto left = left_by_a_dead_program(scratch);
  ASSERT_TRUE(std::filesystem::exists(left / "ledger.sqlite"));
  std::filesystem::create_directory(scratch / "of-another-program");
  std::ofstream(folder / "ledger.try-a1b2c3") << "left by a trial";
  std::ofstream(folder / "ledger.sqlite.damaged-1") << "kept for whoever can read it";
  const auto live = Ledger::stand_in(folder.text(), scratch.text(), "it is read-only");
  ASSERT_TRUE(live) << live.error().what;
  Ledger::sweep(folder.text(), scratch.text());
  EXPECT_FALSE(std::filesystem::exists(left));
  EXPECT_FALSE(std::filesystem::exists(folder / "ledger.try-a1b2c3"));
  EXPECT_TRUE(std::filesystem::exists(folder / "ledger.sqlite.damaged-1"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "of-another-program"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.text()), {}), 2)
      << "the live one is there";
  EXPECT_TRUE(live->reports());
  Ledger::sweep("/nowhere", "/nowhere");
}

TEST(LedgerThatStandsIn, IsEmptyWhereNothingCanBeRead) {
  const Folder scratch;
  const auto ledger = Ledger::stand_in("/nowhere", scratch.text(), "there is no folder");
  ASSERT_TRUE(ledger) << ledger.error().what;
  EXPECT_TRUE(ledger->reports()->empty());
  EXPECT_EQ(ledger->refusal(), "there is no folder");
  EXPECT_FALSE(Ledger::can_be_opened("/nowhere"));
  EXPECT_TRUE(Ledger::can_be_opened(scratch.text()));
}

TEST(FullDiskOfALedger, IsSaidWhereThereIsNoLedgerYet) {
  const Folder folder;
  {
    const FullDisk full(0);
    const auto ledger = Ledger::open(folder.text());
    ASSERT_FALSE(ledger);
    EXPECT_EQ(ledger.error().kind, Error::Kind::Full) << ledger.error().what;
  }
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

/// As a disk that fails: nothing that SQLite writes gets there.
class FailingDisk {
 public:
  FailingDisk() { vfs()->xSetSystemCall(vfs(), kWrite, reinterpret_cast<sqlite3_syscall_ptr>(&fail)); }
  ~FailingDisk() { vfs()->xSetSystemCall(vfs(), kWrite, nullptr); }
  FailingDisk(const FailingDisk&) = delete;
  FailingDisk& operator=(const FailingDisk&) = delete;

 private:
  static constexpr const char* kWrite = "pwrite64";
  static sqlite3_vfs* vfs() { return sqlite3_vfs_find(nullptr); }
  static ssize_t fail(int, const void*, std::size_t, off_t) {
    errno = EIO;
    return -1;
  }
};

TEST(FailingDiskOfALedger, IsSaidWhereItIsOpened) {
  const Folder folder;
  {
    const FailingDisk disk;
    const auto ledger = Ledger::open(folder.text());
    ASSERT_FALSE(ledger);
    EXPECT_EQ(ledger.error().kind, Error::Kind::Failing) << ledger.error().what;
    EXPECT_NE(ledger.error().kind, Error::Kind::Full);
  }
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

/// A file system of its own, of 6 MiB. Needs the right to mount.
class SmallDisk {
 public:
  explicit SmallDisk(const Folder& folder) : path_(folder.text()) {
    mounted_ = ::mount("adit-test", path_.c_str(), "tmpfs", 0, "size=6m,nr_inodes=20") == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  std::string filler() const { return path_ + "/filler"; }

  /// No file can be made in it any more.
  void use_up_names() const {
    for (int i = 0; std::ofstream(filler() + std::to_string(i)).is_open();) ++i;
  }

  /// Takes all room that is left.
  void fill_up() const {
    std::ofstream file(filler(), std::ios::binary);
    const std::string block(4096, 'x');
    while (file.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) continue;
  }

 private:
  std::string path_;
  bool mounted_ = false;
};

/// SQLite then looks for a file that it might at least read, and says that there is none.
TEST(FullDiskOfALedger, IsSaidWhereNoFileCanBeMadeBesideIt) {
  const Folder folder;
  const SmallDisk disk(folder);
  if (!disk.mounted()) GTEST_SKIP() << "this needs the right to mount: " << std::strerror(errno);
  open_or_fail(folder);  // and ended in order: its log is gone
  disk.use_up_names();
  const auto ledger = Ledger::open(folder.text());
  ASSERT_FALSE(ledger);
  EXPECT_EQ(ledger.error().kind, Error::Kind::Full) << ledger.error().what;
}

/// The folder's file system is read-only from when SQLite opens its log. Needs the right to mount.
class TurnsReadOnly {
 public:
  explicit TurnsReadOnly(const Folder& folder) {
    path = folder.text();
    vfs()->xSetSystemCall(vfs(), kOpen, reinterpret_cast<sqlite3_syscall_ptr>(&open));
  }
  ~TurnsReadOnly() {
    vfs()->xSetSystemCall(vfs(), kOpen, nullptr);
    if (mounted) ::umount2(path.c_str(), MNT_DETACH);
  }
  TurnsReadOnly(const TurnsReadOnly&) = delete;
  TurnsReadOnly& operator=(const TurnsReadOnly&) = delete;

 private:
  static constexpr const char* kOpen = "open";
  static sqlite3_vfs* vfs() { return sqlite3_vfs_find(nullptr); }
  /// What is open for writing keeps the kernel from remounting it: an empty one is mounted over it.
  static int open(const char* file, int flags, int mode) {
    if (!mounted && std::string_view(file).ends_with("-wal"))
      mounted = ::mount("adit-test", path.c_str(), "tmpfs", MS_RDONLY, nullptr) == 0;
    return ::open(file, flags, mode);
  }
  static inline std::string path;
  static inline bool mounted = false;
};

TEST(ReadOnlyDiskOfALedger, IsSaidWhereItTurnsSoWhileItIsOpened) {
  const Folder folder;
  open_or_fail(folder);
  const TurnsReadOnly turns(folder);
  const auto ledger = Ledger::open(folder.text());
  if (ledger) GTEST_SKIP() << "this needs the right to mount";
  EXPECT_EQ(ledger.error().kind, Error::Kind::ReadOnly) << ledger.error().what;
}

TEST(FullDiskOfALedger, LeavesTheRoomThatItReservedForReportsUnderWay) {
  const Folder folder;
  const SmallDisk disk(folder);
  if (!disk.mounted()) GTEST_SKIP() << "this needs the right to mount: " << std::strerror(errno);
  std::vector<dispatch::Report> reports;
  {
    auto ledger = open_or_fail(folder);
    disk.fill_up();
    const Error error = fill(ledger, reports);
    EXPECT_EQ(error.kind, Error::Kind::Full) << error.what;
    EXPECT_GT(reports.size(), 300u) << "one run has 45";
    EXPECT_THAT(*ledger.reports(), ElementsAreArray(reports));
    ASSERT_TRUE(std::filesystem::remove(disk.filler()));
    reports.push_back(backpack(30000));
    ASSERT_TRUE(write(ledger, reports.back())) << "there is space again";
  }
  EXPECT_THAT(*open_or_fail(folder).reports(), ElementsAreArray(reports));
}

}  // namespace
}  // namespace adit::ledger
