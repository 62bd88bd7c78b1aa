#include "ledger/ledger.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <cmath>
#include <string>
#include <vector>

#include "ledger/folder.hpp"

namespace adit::ledger {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The first column of each row, read by a connection of the test's own; the ledger must be closed.
std::vector<std::string> read(const Folder& folder, const std::string& sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(folder.file().c_str(), &database), SQLITE_OK);
  std::vector<std::string> rows;
  const auto collect = [](void* out, int, char** values, char**) {
    static_cast<std::vector<std::string>*>(out)->emplace_back(values[0] != nullptr ? values[0] : "NULL");
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), collect, &rows, nullptr), SQLITE_OK);
  sqlite3_close(database);
  return rows;
}

TEST(Ledger, GivesBackWhatItWasGiven) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.add(backpack(), "10.0.0.7", "received", 1700000000.25), 1);
  const Entry entry = find_or_fail(ledger, 1);
  EXPECT_EQ(entry.number, 1);
  EXPECT_EQ(entry.report, backpack());
  EXPECT_EQ(entry.sender, "10.0.0.7");
  EXPECT_EQ(entry.received, 1700000000.25);
  EXPECT_EQ(entry.changed, 1700000000.25);
  EXPECT_EQ(entry.state, "received");
  EXPECT_EQ(entry.status, 0);
  EXPECT_EQ(entry.content_type, "");
  EXPECT_EQ(entry.answer, "");
  EXPECT_EQ(entry.note, "");
}

TEST(Ledger, FindsNothingUnderANumberItNeverGave) {
  const Folder folder;
  const auto found = open_or_fail(folder).find(7);
  ASSERT_TRUE(found);
  EXPECT_FALSE(*found);
}

TEST(Ledger, ListsReportsOldestFirst) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(ledger.add(backpack(i), "", "received", 100 - i));
  const auto all = ledger.all();
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 12u);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(all->at(i).report.position.x, i);
}

TEST(Ledger, KeepsAStepAcrossReopening) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(ledger.add(backpack(), "10.0.0.7", "received", 10));
    Entry entry = find_or_fail(ledger, 1);
    entry.state = "answered";
    entry.status = 201;
    entry.content_type = "application/json";
    entry.answer = R"({"score_change":1})";
    entry.note = "scored";
    ASSERT_TRUE(ledger.change(entry, 12.5));
  }
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.damage(), "");
  const Entry entry = find_or_fail(ledger, 1);
  EXPECT_EQ(entry.state, "answered");
  EXPECT_EQ(entry.status, 201);
  EXPECT_EQ(entry.content_type, "application/json");
  EXPECT_EQ(entry.answer, R"({"score_change":1})");
  EXPECT_EQ(entry.note, "scored");
  EXPECT_EQ(entry.received, 10);
  EXPECT_EQ(entry.changed, 12.5);
}

TEST(Ledger, ChangesOnlyTheStepAndNeverTheReportItself) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(ledger.add(backpack(), "10.0.0.7", "received", 10));
  Entry entry = find_or_fail(ledger, 1);
  entry.report = {"Drill", {9, 9, 9}};
  entry.sender = "someone else";
  entry.received = 99;
  ASSERT_TRUE(ledger.change(entry, 11));
  const Entry kept = find_or_fail(ledger, 1);
  EXPECT_EQ(kept.report, backpack());
  EXPECT_EQ(kept.sender, "10.0.0.7");
  EXPECT_EQ(kept.received, 10);
}

TEST(Ledger, KeepsTheHistoryOfEachReport) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(ledger.add(backpack(), "", "received", 10));
    Entry entry = find_or_fail(ledger, 1);
    for (const char* state : {"sending", "in doubt", "settled"}) {
      entry.state = state;
      entry.note = std::string("note of ") + state;
      ASSERT_TRUE(ledger.change(entry, entry.changed + 1));
    }
  }
  EXPECT_THAT(read(folder, "SELECT report || ' ' || state || ': ' || note FROM step ORDER BY rowid"),
              ElementsAre("1 received: ", "1 sending: note of sending", "1 in doubt: note of in doubt",
                          "1 settled: note of settled"));
}

TEST(Ledger, RefusesAStepOfAReportItDoesNotHaveAndLeavesNoTraceOfIt) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    Entry entry;
    entry.number = 3;
    const auto changed = ledger.change(entry, 1);
    ASSERT_FALSE(changed);
    EXPECT_THAT(changed.error().what, HasSubstr("report 3"));
    EXPECT_FALSE(changed.error().full);
    EXPECT_EQ(ledger.add(backpack(), "", "received", 1), 1) << "the failed step still holds its transaction";
  }
  EXPECT_THAT(read(folder, "SELECT count(*) FROM step"), ElementsAre("1"));
}

TEST(Ledger, NeverUsesANumberTwiceEvenWhenARowWasDeletedByHand) {
  const Folder folder;
  for (int number = 1; number <= 3; ++number) {
    EXPECT_EQ(open_or_fail(folder).add(backpack(), "", "received", 1), number);
    read(folder, "DELETE FROM step; DELETE FROM report");
  }
}

TEST(Ledger, KeepsHostileTextByteForByte) {
  const std::string hostile[] = {"",
                                 "'); DROP TABLE report; --",
                                 std::string("nul\0inside", 10),
                                 "\xff\xfe not UTF-8",
                                 "?1 :a $b @c %s",
                                 "é",
                                 std::string(70000, 'x')};
  const Folder folder;
  auto ledger = open_or_fail(folder);
  for (const auto& text : hostile) {
    const auto number = ledger.add({text, {0, -0.0, 1e308}}, text, text, 1);
    ASSERT_TRUE(number) << number.error().what;
    Entry entry = find_or_fail(ledger, *number);
    EXPECT_EQ(entry.report.type, text);
    EXPECT_EQ(entry.sender, text);
    EXPECT_EQ(entry.state, text);
    EXPECT_EQ(entry.report.position.z, 1e308);
    entry.answer = entry.note = entry.content_type = text;
    ASSERT_TRUE(ledger.change(entry, 2));
    entry = find_or_fail(ledger, *number);
    EXPECT_EQ(entry.answer, text);
    EXPECT_EQ(entry.note, text);
    EXPECT_EQ(entry.content_type, text);
  }
  EXPECT_EQ(ledger.all()->size(), std::size(hostile));
}

TEST(Ledger, RefusesAPositionThatIsNoNumber) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  EXPECT_FALSE(ledger.add({"Drill", {std::nan(""), 0, 0}}, "", "received", 1));
  EXPECT_TRUE(ledger.all()->empty());
}

TEST(Ledger, IsReadableByItsOwnerAlone) {
  const Folder folder;
  const mode_t before = ::umask(0);
  auto ledger = open_or_fail(folder);
  ::umask(before);
  ASSERT_TRUE(ledger.add(backpack(), "", "received", 1));
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.text())) {
    struct stat status{};
    ASSERT_EQ(::stat(file.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600u) << file.path();
    ++files;
  }
  EXPECT_GE(files, 2) << "the -wal too";
}

TEST(Ledger, TightensTheModeOfAFileItFinds) {
  const Folder folder;
  {
    open_or_fail(folder);
  }
  ASSERT_EQ(::chmod(folder.file().c_str(), 0666), 0);
  const auto ledger = open_or_fail(folder);
  struct stat status{};
  ASSERT_EQ(::stat(folder.file().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST(Ledger, WritesEachStepThroughToTheDisk) {
  const Folder folder;
  {
    open_or_fail(folder);
  }
  EXPECT_THAT(read(folder, "PRAGMA journal_mode"), ElementsAre("wal"));
  EXPECT_THAT(read(folder, "PRAGMA user_version"), ElementsAre("1"));
}

TEST(Ledger, SaysWhichFolderIsMissing) {
  const Folder folder;
  const auto ledger = Ledger::open(folder.text() + "/absent");
  ASSERT_FALSE(ledger);
  EXPECT_THAT(ledger.error().what, HasSubstr("/absent/ledger.sqlite"));
  EXPECT_THAT(ledger.error().what, HasSubstr("No such file"));
}

}  // namespace
}  // namespace adit::ledger
