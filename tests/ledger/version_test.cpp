#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "ledger/folder.hpp"
#include "ledger/full_disk.hpp"

namespace adit::ledger {
namespace {

using dispatch::ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

/// What version 1 made, with three reports in it.
constexpr const char* kVersion1 = R"(
  PRAGMA journal_mode = WAL;
  CREATE TABLE report(
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    type TEXT NOT NULL, x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL,
    sender TEXT NOT NULL, received REAL NOT NULL, changed REAL NOT NULL,
    state TEXT NOT NULL, status INTEGER NOT NULL, content_type TEXT NOT NULL,
    answer BLOB NOT NULL, note TEXT NOT NULL) STRICT;
  CREATE TABLE step(
    report INTEGER NOT NULL REFERENCES report(number),
    at REAL NOT NULL, state TEXT NOT NULL, note TEXT NOT NULL) STRICT;
  PRAGMA application_id = 0x41444954;
  PRAGMA user_version = 1;
  INSERT INTO report VALUES
    (1, 'Backpack', 1.5, -2.25, 0.125, '10.0.0.7', 10, 12, 'answered', 201, 'application/json', x'7b00ff', ''),
    (2, 'Backpack', 2.5, -2.25, 0.125, '10.0.0.7', 10, 11, 'in doubt', 0, '', x'', 'no answer came'),
    (5, 'Backpack', 5.5, -2.25, 0.125, '10.0.0.7', 10, 10, 'waiting', 0, '', x'', '');
  INSERT INTO step VALUES
    (1, 10, 'waiting', ''), (2, 10, 'waiting', ''), (1, 11, 'sending', ''), (2, 10.5, 'sending', ''),
    (1, 12, 'answered', ''), (2, 11, 'in doubt', 'no answer came'), (5, 10, 'waiting', '');
)";

void expect_the_three_reports(const Ledger& ledger) {
  dispatch::Report first = backpack(1), second = backpack(2, 2.5);
  first.changed = 12;
  first.state = ReportState::Answered;
  first.status = 201;
  first.content_type = "application/json";
  first.answer = std::string("{\0\xff", 3);
  second.changed = 11;
  second.state = ReportState::InDoubt;
  second.note = "no answer came";
  EXPECT_THAT(*ledger.reports(), ElementsAre(first, second, backpack(5, 5.5)));
  EXPECT_THAT(*ledger.history(2),
              ElementsAre(Ledger::Step{2, 10, "queued", ""}, Ledger::Step{2, 10.5, "sending", ""},
                          Ledger::Step{2, 11, "in_doubt", "no answer came"}));
  EXPECT_TRUE(ledger.runs()->empty());
}

TEST(LedgerOfVersion1, IsBroughtUpToThisOneWithAllThatIsInIt) {
  const Folder folder;
  by_hand(folder, kVersion1);
  for (int opening = 1; opening <= 2; ++opening) {
    SCOPED_TRACE(opening);
    const auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.damage(), "");
    expect_the_three_reports(ledger);
  }
  EXPECT_THAT(by_hand(folder, "PRAGMA user_version"), ElementsAre("196613"));
  EXPECT_THAT(by_hand(folder, "SELECT name FROM sqlite_schema WHERE name LIKE 'old%'"), ElementsAre());
}

TEST(LedgerOfVersion1, TakesNewStepsOnceItWasBroughtUp) {
  const Folder folder;
  by_hand(folder, kVersion1);
  auto ledger = open_or_fail(folder);
  dispatch::Report waiting = find_or_fail(ledger, 5);
  waiting.state = ReportState::Sending;
  waiting.run = 1;
  waiting.before = icd::RunStatus{1, 2, 3, "adit"};
  ASSERT_TRUE(write(ledger, waiting));
  ASSERT_TRUE(write(ledger, backpack(6)));
  EXPECT_EQ(find_or_fail(ledger, 5), waiting);
  EXPECT_EQ(ledger.history(5)->size(), 2u);
}

void expect_the_tables_of_a_new_one(const char* sql) {
  const Folder old, fresh;
  by_hand(old, sql);
  open_or_fail(old);
  open_or_fail(fresh);
  const char* tables = "SELECT sql FROM sqlite_schema WHERE name NOT LIKE 'sqlite_%' ORDER BY name";
  EXPECT_EQ(by_hand(old, tables), by_hand(fresh, tables));
  EXPECT_EQ(by_hand(fresh, tables).size(), 7u) << "five tables and two triggers";
}

TEST(LedgerOfVersion1, HasTheSameTablesAfterwardsAsANewOne) {
  expect_the_tables_of_a_new_one(kVersion1);
}

TEST(LedgerOfVersion1, StaysAsItIsWhereThereIsNoRoomToBringItUp) {
  const Folder folder;
  by_hand(folder, kVersion1);
  {
    const FullDisk full(20000);
    const auto ledger = Ledger::open(folder.text());
    ASSERT_FALSE(ledger);
    EXPECT_EQ(ledger.error().kind, Error::Kind::Full) << ledger.error().what;
  }
  EXPECT_THAT(by_hand(folder, "PRAGMA user_version"), ElementsAre("1"));
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.damage(), "");
  expect_the_three_reports(ledger);
}

/// What version 2 made, with a report that was found out, one without a history, and a run in it.
constexpr const char* kVersion2 = R"(
  PRAGMA journal_mode = WAL;
  CREATE TABLE report(
    number INTEGER PRIMARY KEY CHECK(number > 0),
    type TEXT NOT NULL, x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL,
    sender TEXT NOT NULL, received REAL NOT NULL, changed REAL NOT NULL,
    state TEXT NOT NULL, note TEXT NOT NULL,
    run INTEGER NOT NULL DEFAULT 0, asked INTEGER NOT NULL DEFAULT 0, same_as INTEGER NOT NULL DEFAULT 0,
    tries INTEGER NOT NULL DEFAULT 0, sending INTEGER NOT NULL DEFAULT 0, sent REAL NOT NULL DEFAULT 0,
    before_score INTEGER, before_run_clock REAL, before_remaining_reports INTEGER, before_current_team TEXT,
    status INTEGER NOT NULL, content_type TEXT NOT NULL, answer BLOB NOT NULL,
    reconciled INTEGER NOT NULL DEFAULT 0) STRICT;
  CREATE TABLE step(
    report INTEGER NOT NULL REFERENCES report(number),
    at REAL NOT NULL, state TEXT NOT NULL, note TEXT NOT NULL) STRICT;
  CREATE TABLE run(
    number INTEGER PRIMARY KEY CHECK(number > 0),
    id TEXT NOT NULL, began REAL NOT NULL, why TEXT NOT NULL,
    score INTEGER, run_clock REAL, remaining_reports INTEGER, current_team TEXT,
    heard REAL NOT NULL, post TEXT NOT NULL, unreliable TEXT NOT NULL) STRICT;
  PRAGMA application_id = 0x41444954;
  PRAGMA user_version = 2;
  INSERT INTO report VALUES
    (1, 'Backpack', 1.5, -2.25, 0.125, '10.0.0.7', 10, 12, 'settled', 'it was "there"', 3, 1, 0, 1, 4, 11, 2, 100,
     19, 'adit', 201, 'application/json', x'7b00ff', 1),
    (2, 'Backpack', 2.5, -2.25, 0.125, '10.0.0.7', 10, 11, 'in doubt', 'no answer came', 3, 0, 1, 0, 0, 0, NULL,
     NULL, NULL, NULL, 0, '', x'', 0);
  INSERT INTO step VALUES (1, 10, 'waiting', ''), (1, 11, 'sending', ''), (1, 12, 'settled', 'it was "there"');
  INSERT INTO run VALUES (3, '1.5.2', 9, 'declared', 2, 100, 19, 'adit', 11.5, '10.100.1.200:8000', 'why');
)";

TEST(LedgerOfVersion2, IsBroughtUpToThisOneWithAllThatIsInIt) {
  const Folder folder;
  by_hand(folder, kVersion2);
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.damage(), "");
  dispatch::Report first = backpack(1), second = backpack(2, 2.5);
  first.changed = 12;
  first.state = ReportState::Settled;
  first.note = "it was \"there\"";
  first.run = second.run = 3;
  first.asked = first.reconciled = true;
  first.tries = 1;
  first.sending = 4;
  first.sent = 11;
  first.before = icd::RunStatus{2, 100, 19, "adit"};
  first.status = 201;
  first.content_type = "application/json";
  first.answer = std::string("{\0\xff", 3);
  second.changed = 11;
  second.state = ReportState::InDoubt;
  second.note = "no answer came";
  second.same_as = 1;
  EXPECT_THAT(*ledger.reports(), ElementsAre(first, second));
  EXPECT_THAT(*ledger.history(1),
              ElementsAre(Ledger::Step{1, 10, "queued", ""}, Ledger::Step{1, 11, "sending", ""},
                          Ledger::Step{1, 12, "settled", "it was \"there\""}));
  EXPECT_THAT(*ledger.history(2), ElementsAre());
  const auto runs = *ledger.runs();
  ASSERT_EQ(runs.size(), 1u);
  const dispatch::Run* const run = &runs.front();
  EXPECT_EQ(run->number, 3);
  EXPECT_EQ(run->id, "1.5.2");
  EXPECT_EQ(run->last, (icd::RunStatus{2, 100, 19, "adit"}));
  EXPECT_EQ(run->unreliable, "why");
}

TEST(LedgerOfVersion2, HasTheSameTablesAfterwardsAsANewOne) {
  expect_the_tables_of_a_new_one(kVersion2);
}

/// This version's tables without what it added.
constexpr const char* kBackToVersion3 = R"(
  DROP TRIGGER report_without_proof;
  DROP TRIGGER run_without_proof;
  DROP TABLE mark;
  DROP TABLE sighting;
  DROP TABLE robot;
  ALTER TABLE report DROP COLUMN proof;
  ALTER TABLE run DROP COLUMN proof;
  PRAGMA user_version = 3;
)";

TEST(LedgerOfVersion3, KeepsItsRunsOfWhichNothingMoreWasSeen) {
  const dispatch::Run run{.number = 1, .id = "1", .last = icd::RunStatus{2, 100, 19, "adit"}, .post = "a:1"};
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
    ASSERT_TRUE(ledger.write(run));
  }
  by_hand(folder, kBackToVersion3);
  {
    auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.damage(), "");
    EXPECT_THAT(*ledger.reports(), ElementsAre(backpack(1)));
    EXPECT_THAT(*ledger.runs(), ElementsAre(run));
    dispatch::Run seen = run;
    seen.answer_clock = dispatch::Clock{3.14, false};
    ASSERT_TRUE(ledger.write(seen));
    EXPECT_THAT(*ledger.runs(), ElementsAre(seen));
  }
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

TEST(LedgerOfVersion3, HasTheSameTablesAfterwardsAsANewOne) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
  }
  const char* const kSchema = "SELECT sql FROM sqlite_schema WHERE name NOT LIKE 'sqlite%' ORDER BY name";
  const auto tables = by_hand(folder, kSchema);
  by_hand(folder, kBackToVersion3);
  {
    auto ledger = open_or_fail(folder);
  }
  EXPECT_EQ(by_hand(folder, kSchema), tables);
}

/// This version's tables without what it added to version 4's.
constexpr const char* kBackToVersion4 = "DROP TABLE robot; PRAGMA user_version = 196612;";  // 3 << 16 | 4

TEST(LedgerOfVersion4, HasReportsThatNameNoRobotAndTheSameTablesAfterwardsAsANewOne) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  const char* const kSchema = "SELECT sql FROM sqlite_schema WHERE name NOT LIKE 'sqlite%' ORDER BY name";
  const auto tables = by_hand(folder, kSchema);
  by_hand(folder, kBackToVersion4);
  {
    auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.damage(), "");
    EXPECT_THAT(*ledger.reports(), ElementsAre(backpack(1)));
    ASSERT_TRUE(write(ledger, named_backpack(2, "spot1")));
  }
  EXPECT_EQ(by_hand(folder, kSchema), tables);
  EXPECT_THAT(*open_or_fail(folder).reports(), ElementsAre(backpack(1), named_backpack(2, "spot1")));
}

/// What version 3 does to two reports and a run.
constexpr const char* kWrittenByVersion3 = R"(
    INSERT INTO report(number, type, x, y, z, sender, received, changed, state, note, status, content_type,
      answer, history)
    VALUES (1, 'Backpack', 1.5, -2.25, 0.125, '10.0.0.7', 10, 11, 'sending', '', 0, '', x'', '11 7:sending 0:' || char(10)),
      (3, 'Backpack', 1.5, -2.25, 0.125, '10.0.0.7', 10, 10, 'waiting', '', 0, '', x'', '10 7:waiting 0:' || char(10))
    ON CONFLICT(number) DO UPDATE SET state = excluded.state, changed = excluded.changed,
      history = history || excluded.history;
    UPDATE run SET heard = 12)";

/// An update that was reverted, and made again: what wrote in between knew no proofs.
TEST(LedgerOfThisVersion, IsWorkedWithByVersion3) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(ledger.write(std::vector{backpack(1), backpack(2)}));
    ASSERT_TRUE(ledger.write(dispatch::Run{.number = 1, .post = "a:1"}));
  }
  by_hand(folder, kWrittenByVersion3);
  EXPECT_THAT(
      by_hand(folder,
              "SELECT number || (proof = 1) FROM report UNION ALL SELECT 'run' || (proof = 1) FROM run"),
      ElementsAre("11", "20", "31", "run1"));
  {
    const auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.damage(), "");
    EXPECT_EQ(find_or_fail(ledger, 1).state, ReportState::Sending);
    EXPECT_EQ(ledger.runs()->back().heard, 12);
  }
  EXPECT_THAT(by_hand(folder, "SELECT number FROM report WHERE proof = 1"), ElementsAre());
}

/// Its rows have no proof, and the mark does not know of them.
TEST(LedgerOfThisVersion, KeepsWhatVersion3WroteWhenItIsSalvaged) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(ledger.write(std::vector{backpack(1), backpack(2)}));
    ASSERT_TRUE(ledger.write(dispatch::Run{.number = 1, .post = "a:1"}));
  }
  by_hand(folder, kWrittenByVersion3);
  by_hand(folder, "PRAGMA application_id = 7");
  const auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), HasSubstr("3 reports were copied to a new ledger"));
  EXPECT_THAT(ledger.damage(), HasSubstr("from 4 on may be lost"));
  EXPECT_EQ(find_or_fail(ledger, 1).state, ReportState::InDoubt);
  EXPECT_EQ(find_or_fail(ledger, 3).report, backpack(3).report);
  EXPECT_EQ(ledger.runs()->back().heard, 12);
}

TEST(LedgerOfThisVersion, IsOpenedWhicheverBitOfItsVersionIsFlipped) {
  for (int bit = 0; bit < 31; ++bit) {
    SCOPED_TRACE(bit);
    const Folder folder;
    {
      auto ledger = open_or_fail(folder);
      ASSERT_TRUE(write(ledger, backpack(1)));
    }
    by_hand(folder, "PRAGMA user_version = " + std::to_string((3 << 16 | 5) ^ (1 << bit)));
    const auto ledger = Ledger::open(folder.text());
    ASSERT_TRUE(ledger) << ledger.error().what;
    EXPECT_EQ(find_or_fail(*ledger, 1).report, backpack(1).report);
  }
}

/// What a later version might add, and say that this one can live with.
constexpr const char* kAdditions = R"(
  ALTER TABLE report ADD COLUMN crew TEXT NOT NULL DEFAULT '';
  CREATE TABLE more(thing TEXT NOT NULL) STRICT;
  INSERT INTO more VALUES ('kept');
  UPDATE report SET crew = 'ugv1';
  PRAGMA user_version = 196614; -- 3 << 16 | 6
)";

TEST(LedgerOfALaterVersionThatOnlyAdds, IsWorkedWithAndKeepsItsAdditions) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  by_hand(folder, kAdditions);
  {
    auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.damage(), "");
    dispatch::Report first = find_or_fail(ledger, 1);
    EXPECT_EQ(first, backpack(1));
    first.state = ReportState::Sending;
    ASSERT_TRUE(write(ledger, first));
    ASSERT_TRUE(write(ledger, backpack(2)));
  }
  EXPECT_THAT(by_hand(folder, "PRAGMA user_version"), ElementsAre("196614"));
  EXPECT_THAT(by_hand(folder, "SELECT thing FROM more"), ElementsAre("kept"));
  EXPECT_THAT(by_hand(folder, "SELECT number || state || crew FROM report ORDER BY number"),
              ElementsAre("1sendingugv1", "2waiting"));
}

TEST(LedgerOfALaterVersionThatOnlyAdds, IsRefusedWhereThatIsToAVersionLaterThanThis) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
  }
  by_hand(folder, "PRAGMA user_version = 393223");  // 6 << 16 | 7
  const auto refused = Ledger::open(folder.text());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("version 7, this Adit reads up to 5"));
  EXPECT_THAT(by_hand(folder, "PRAGMA user_version"), ElementsAre("393223"));
}

TEST(LedgerOfALaterVersion, IsRefusedWithASentenceAndStaysAsItIs) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  // A table that this version's SQLite, too, would understand, so that the number alone decides.
  by_hand(folder, "CREATE TABLE crew(name TEXT) STRICT; DROP TABLE run; PRAGMA user_version = 6");
  const auto bytes = [&folder] {
    std::ifstream file(folder.file(), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string before = bytes();
  const auto ledger = Ledger::open(folder.text());
  ASSERT_FALSE(ledger);
  EXPECT_THAT(ledger.error().what, HasSubstr("a later Adit wrote this ledger (version 6"));
  EXPECT_NE(ledger.error().kind, Error::Kind::Full);
  EXPECT_EQ(bytes(), before);
  EXPECT_FALSE(std::filesystem::exists(folder.file() + ".damaged-1"));
}

}  // namespace
}  // namespace adit::ledger
