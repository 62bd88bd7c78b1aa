#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "ledger/folder.hpp"

namespace adit::ledger {
namespace {

using testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void save(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A whole ledger of some pages.
std::string healthy_bytes() {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    for (int number = 1; number <= 200; ++number) EXPECT_TRUE(write(ledger, backpack(number)));
  }
  return bytes_of(folder.file());
}

/// That the file was set aside whole, a new ledger works, and its sentence says where the old one is.
void expect_set_aside(const Folder& folder, const std::string& bytes) {
  auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), HasSubstr(folder.file() + ".damaged-1"));
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-1"), bytes);
  EXPECT_TRUE(ledger.reports()->empty());
  EXPECT_TRUE(write(ledger, backpack(1)));
}

TEST(DamagedLedger, IsSetAsideWhenItIsRandomBytes) {
  std::mt19937_64 random(1);
  std::string bytes(20000, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  const Folder folder;
  save(folder.file(), bytes);
  expect_set_aside(folder, bytes);
}

TEST(DamagedLedger, IsSetAsideWhenItIsTruncated) {
  const std::string healthy = healthy_bytes();
  for (const std::size_t size :
       {std::size_t{50}, std::size_t{4096}, healthy.size() / 2, healthy.size() - 4096}) {
    const Folder folder;
    save(folder.file(), healthy.substr(0, size));
    SCOPED_TRACE(size);
    expect_set_aside(folder, healthy.substr(0, size));
  }
}

TEST(DamagedLedger, IsSetAsideWhenAPageIsOverwritten) {
  std::string bytes = healthy_bytes();
  constexpr std::size_t kPage = 4096;
  ASSERT_GT(bytes.size(), 3 * kPage);
  for (std::size_t i = kPage; i < 3 * kPage; ++i) bytes[i] = '\xa5';
  const Folder folder;
  save(folder.file(), bytes);
  expect_set_aside(folder, bytes);
}

TEST(DamagedLedger, IsSetAsideWhenItIsAnotherProgramsDatabase) {
  const Folder folder;
  by_hand(folder, "CREATE TABLE report(number INTEGER); PRAGMA user_version = 9");
  auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), HasSubstr("another program's"));
  EXPECT_TRUE(ledger.reports()->empty());
}

TEST(DamagedLedger, IsSetAsideWhenItHasAVersionThatNeverWas) {
  const Folder folder;
  {
    open_or_fail(folder);
  }
  by_hand(folder, "PRAGMA user_version = 0");
  EXPECT_THAT(open_or_fail(folder).damage(), HasSubstr("version 0"));
}

TEST(DamagedLedger, TakesItsWriteAheadLogAlong) {
  const Folder folder;
  save(folder.file(), std::string(5000, 'x'));
  save(folder.file() + "-wal", "old wal");
  save(folder.file() + "-shm", "old shm");
  {
    EXPECT_NE(open_or_fail(folder).damage(), "");
  }
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-1-wal"), "old wal");
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-1-shm"), "old shm");
}

TEST(DamagedLedger, NeverReplacesAnEarlierOne) {
  const Folder folder;
  for (const char* content : {"first, no ledger", "second, no ledger"}) {
    save(folder.file(), content);
    open_or_fail(folder);
  }
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-1"), "first, no ledger");
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-2"), "second, no ledger");
}

TEST(DamagedLedger, IsForgottenAtTheNextOpening) {
  const Folder folder;
  save(folder.file(), "no ledger");
  {
    EXPECT_NE(open_or_fail(folder).damage(), "");
  }
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

TEST(BlankLedger, IsSaidToHaveLostWhatItHeld) {
  const std::string healthy = healthy_bytes();
  for (const std::string& bytes : {std::string(), healthy.substr(0, 68) + std::string(4028, '\0')}) {
    const Folder folder;
    save(folder.file(), bytes);
    EXPECT_NE(open_or_fail(folder).damage(), "") << bytes.size();
  }
}

TEST(BlankLedger, IsNotANewOne) {
  const Folder folder;
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

}  // namespace
}  // namespace adit::ledger
