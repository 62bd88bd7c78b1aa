#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <vector>

#include "ledger/folder.hpp"

namespace {
int flushes = 0;
bool flushes_fail = false;

int count_and_call(const char* name, int file) {
  ++flushes;
  if (flushes_fail) {
    errno = EIO;
    return -1;
  }
  return reinterpret_cast<int (*)(int)>(::dlsym(RTLD_NEXT, name))(file);
}
}  // namespace

// SQLite is a shared library: these stand before the C library's own for all of this program.
extern "C" {
int fdatasync(int file) {
  return count_and_call("fdatasync", file);
}
int fsync(int file) {
  return count_and_call("fsync", file);
}
}

namespace adit::ledger {
namespace {

/// How many flushes `write` makes.
template <class Write>
int flushes_of(Write write) {
  flushes = 0;
  EXPECT_TRUE(write());
  return flushes;
}

std::uintmax_t log_size(const Folder& folder) {
  return std::filesystem::file_size(folder.file() + "-wal");
}

TEST(LedgerFlushes, OnceForEachWrite) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  const std::vector<dispatch::Report> several{backpack(2), backpack(3), backpack(2)};
  dispatch::Run run{.number = 1};
  ASSERT_TRUE(write(ledger, backpack(1))) << "the first one begins the log, which is a flush more";
  for (int again = 0; again < 20; ++again) {
    EXPECT_EQ(flushes_of([&] { return write(ledger, backpack(1)); }), 1);
    EXPECT_EQ(flushes_of([&] { return ledger.write(several); }), 1);
    run.heard += 1;
    EXPECT_EQ(flushes_of([&] { return ledger.write(run); }), 1);
  }
  EXPECT_EQ(flushes_of([&] { return ledger.write(std::span<const dispatch::Report>()); }), 0);
  EXPECT_EQ(flushes_of([&] { return ledger.reports(); }), 0);
}

TEST(LedgerFlushes, LaterWhereItIsToldTo) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(write(ledger, backpack(1)));
  EXPECT_EQ(flushes_of([&] { return ledger.flush(); }), 0) << "nothing was left";
  const std::vector<dispatch::Report> answered{backpack(1)};
  EXPECT_EQ(flushes_of([&] { return ledger.write(answered, nullptr, dispatch::Flush::Soon); }), 0);
  EXPECT_EQ(flushes_of([&] { return ledger.flush(); }), 1);
  EXPECT_EQ(flushes_of([&] { return ledger.flush(); }), 0);
}

/// After a flush that failed the kernel takes what was to be flushed for written: the next one flushes none
/// of it, and a power cut takes it, and with it all that is behind it in the log.
class AFlushThatFailed : public testing::Test {
 protected:
  AFlushThatFailed() {
    EXPECT_TRUE(write(ledger_, backpack(1)));
    const std::vector<dispatch::Report> answered{backpack(2)};
    EXPECT_TRUE(ledger_.write(answered, nullptr, dispatch::Flush::Soon));
    flushes_fail = true;
  }
  void TearDown() override { flushes_fail = false; }

  /// In the ledger's file, without its log.
  std::vector<std::string> in_the_file_alone() {
    const Folder other;
    std::filesystem::copy_file(folder_.file(), other.file());
    return by_hand(other, "SELECT count(*) FROM report");
  }
  const Folder folder_;
  Ledger ledger_ = open_or_fail(folder_);
};

TEST_F(AFlushThatFailed, LaterIsMadeGoodBeforeAnythingElseIsWritten) {
  EXPECT_FALSE(ledger_.flush());
  EXPECT_FALSE(write(ledger_, backpack(3)));
  flushes_fail = false;
  EXPECT_TRUE(write(ledger_, backpack(3)));
  EXPECT_EQ(in_the_file_alone(), std::vector<std::string>{"2"});
}

TEST_F(AFlushThatFailed, WithWhatWasLeftForLaterIsMadeGood) {
  EXPECT_FALSE(write(ledger_, backpack(3)));
  flushes_fail = false;
  EXPECT_TRUE(ledger_.flush());
  EXPECT_EQ(in_the_file_alone(), std::vector<std::string>{"2"});
}

TEST(LedgerFlushes, MoreThanOnceOnlyWhereTheLogIsRestarted) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  constexpr int kWrites = 1200;
  int more_than_one = 0, most = 0;
  for (int number = 1; number <= kWrites; ++number) {
    const int made = flushes_of([&] { return write(ledger, backpack(number)); });
    if (made > 1) ++more_than_one;
    most = std::max(most, made);
  }
  EXPECT_LE(more_than_one, kWrites / 100);
  EXPECT_LE(most, 4);
}

TEST(LedgerLog, IsOverwrittenInPlaceAndNeverGrowsOrShrinks) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  const std::uintmax_t size = log_size(folder);
  EXPECT_EQ(size, 4u << 20);
  for (int number = 1; number <= 1200; ++number) {
    ASSERT_TRUE(write(ledger, backpack(number)));
    ASSERT_EQ(log_size(folder), size) << "at report " << number;
  }
  EXPECT_LT(std::filesystem::file_size(folder.file()), size) << "1,200 reports are that small";
}

TEST(LedgerLog, IsGoneAfterAnOrderlyEnd) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file() + "-wal"));
  EXPECT_EQ(by_hand(folder, "SELECT count(*) FROM report"), std::vector<std::string>{"1"});
}

}  // namespace
}  // namespace adit::ledger
