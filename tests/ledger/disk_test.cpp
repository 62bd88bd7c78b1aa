// A ledger on a full, read-only or failing disk, and killed processes.
#include "store/disk.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include "ledger/state.hpp"

namespace adit::ledger {
namespace {

using dispatch::Flush;
using dispatch::Report;
using dispatch::ReportState;
using testing::HasSubstr;
using testing::SizeIs;

class LedgerOnDisk : public testing::Test {
 protected:
  LedgerOnDisk() : disk_(store::Random(1, "disk"), "ledger") {}

  Ledger open(const LedgerFacts& known = {}) { return open_or_fail(disk_.path(), known); }
  void expect_all(const Ledger& before) {
    const auto reports = before.reports();
    const LedgerFacts known = before.known_facts();
    const Files files = files_in(disk_.log());
    const State copy;
    put_files(copy.ledger(), files);
    const auto after = open_or_fail(copy.path(), known);
    EXPECT_EQ(after.damage(), "");
    EXPECT_EQ(after.reports(), reports);
  }

  store::Disk disk_;
};

TEST_F(LedgerOnDisk, FullDiskHasRoomForStepsOfKnownReports) {
  auto ledger = open();
  disk_.full = 1;
  std::int64_t last = 0;
  while (write(ledger, backpack(last + 1))) ++last;
  EXPECT_GT(last, 490);
  EXPECT_THAT(ledger.refusal(), HasSubstr("No space left on device"));
  EXPECT_FALSE(ledger.make_ready());
  int steps = 0;
  while (write(ledger, in_state(backpack(1 + steps % last), ReportState::Sending))) ++steps;
  EXPECT_EQ(steps, static_cast<int>(Ledger::kForKnown / 8192));
  expect_all(ledger);
  disk_.full = 0;
  EXPECT_TRUE(ledger.make_ready());
  EXPECT_EQ(ledger.refusal(), "");
  EXPECT_TRUE(write(ledger, backpack(last + 1)));
  expect_all(ledger);
}

TEST_F(LedgerOnDisk, NearlyFullDiskGetsSmallerFiles) {
  auto ledger = open();
  disk_.room = 1'700'000;
  std::int64_t last = 0;
  while (write(ledger, backpack(last + 1))) ++last;
  EXPECT_GT(last, 490 + 100);
  EXPECT_THAT(ledger.refusal(), HasSubstr("No space left on device"));
  EXPECT_GE(*disk_.room, 256u << 10) << "for other files";
  int steps = 0;
  while (write(ledger, in_state(backpack(1 + steps % last), ReportState::Sending))) ++steps;
  EXPECT_EQ(steps, static_cast<int>(Ledger::kForKnown / 8192));
  expect_all(ledger);
  disk_.room.reset();
  EXPECT_TRUE(write(ledger, backpack(last + 1)));
  expect_all(ledger);
}

/// A report of any length leaves that room.
TEST_F(LedgerOnDisk, FullDiskHasRoomAfterALongReport) {
  auto ledger = open();
  disk_.full = 1;
  ASSERT_TRUE(write(ledger, backpack(1)));
  Report report = backpack(2);
  report.report.type.assign(20000, 'x');
  while (write(ledger, report)) ++report.number;
  for (int step = 0; step < 8; ++step) EXPECT_TRUE(write(ledger, backpack(1))) << step;
}

TEST_F(LedgerOnDisk, FullDiskStillFillsASpareFile) {
  auto ledger = open();
  ASSERT_TRUE(keep_up(ledger));
  disk_.full = 1;
  std::int64_t last = 0;
  while (write(ledger, backpack(last + 1))) ++last;
  EXPECT_GT(last, 990);
  expect_all(ledger);
}

/// The log is full and the process ends: no file loses records.
TEST_F(LedgerOnDisk, FullDiskAtTheEndOfAFileIsNoDamage) {
  for (const bool is_killed : {false, true}) {
    std::int64_t last = 0;
    {
      auto ledger = open();
      last = ledger.known_facts().reports;
      disk_.full = 1;
      while (write(ledger, backpack(last + 1))) ++last;
      while (write(ledger, in_state(backpack(1), ReportState::Sending))) continue;
      disk_.kill_at = is_killed ? 1 : 0;
      EXPECT_TRUE(is_killed || ledger.flush());
      try {
        EXPECT_FALSE(write(ledger, backpack(last + 1)));
      } catch (const store::Disk::Killed&) {
      }
    }
    disk_.start();
    {
      const auto full = open();
      EXPECT_EQ(full.damage(), "");
      EXPECT_THAT(full.refusal(), HasSubstr("No space left"));
      EXPECT_THAT(full.reports(), SizeIs(static_cast<std::size_t>(last)));
    }
    disk_.full = 0;
    auto ledger = open();
    EXPECT_EQ(ledger.damage(), "");
    EXPECT_TRUE(write(ledger, backpack(last + 1)));
    expect_all(ledger);
  }
}

TEST_F(LedgerOnDisk, FullDiskIsAnErrorOfUpkeep) {
  auto ledger = open();
  disk_.full = 1;
  EXPECT_FALSE(keep_up(ledger)) << "no room for a spare file";
  disk_.full = 0;
  (void)fill_file(ledger, 1);
  disk_.full = 1;
  EXPECT_FALSE(keep_up(ledger)) << "no room for a snapshot";
  disk_.full = 0;
  EXPECT_TRUE(keep_up(ledger));
  EXPECT_THAT(files_in(disk_.log()).rbegin()->first, testing::StartsWith("snapshot-"));
}

TEST_F(LedgerOnDisk, FullDiskAtTheFirstStartRejectsReports) {
  disk_.full = 1;
  auto ledger = open();
  EXPECT_THAT(ledger.refusal(), HasSubstr("No space left"));
  EXPECT_FALSE(write(ledger, backpack(1)));
  EXPECT_THAT(ledger.reports(), SizeIs(0));
  disk_.full = 0;
  EXPECT_TRUE(write(ledger, backpack(1)));
  EXPECT_EQ(ledger.refusal(), "");
  expect_all(ledger);
}

TEST_F(LedgerOnDisk, ReadOnlyDiskShowsAllAndRejectsReports) {
  {
    ASSERT_TRUE(write(*std::make_unique<Ledger>(open()), backpack(1)));
  }
  const Files before = files_in(disk_.log());
  disk_.is_read_only = true;
  {
    auto ledger = open();
    EXPECT_THAT(ledger.refusal(), HasSubstr("Read-only file system"));
    EXPECT_FALSE(write(ledger, backpack(2)));
    EXPECT_FALSE(write(ledger, in_state(backpack(1), ReportState::Held)));
    EXPECT_THAT(ledger.reports(), testing::ElementsAre(backpack(1)));
    EXPECT_TRUE(files_in(disk_.log()) == before);
    disk_.is_read_only = false;
    EXPECT_TRUE(write(ledger, backpack(2)));
    EXPECT_EQ(ledger.refusal(), "");
    expect_all(ledger);
  }
  disk_.failing_opens = 1;
  EXPECT_THAT(Ledger::open(disk_.path()).error().what, HasSubstr("Too many open files"));
  EXPECT_FALSE(Ledger::can_be_read(disk_.path()));
}

/// Whenever the disk begins to fail, and for how long: an error is returned, and successful writes are
/// kept.
TEST_F(LedgerOnDisk, FailingDiskLosesNoAcceptedReport) {
  std::map<std::int64_t, Report> kept;
  for (int start = 0; start < 6; ++start) {
    disk_.start();
    disk_.failing_syncs = disk_.failing_writes = start % 2 == 0 ? 0.1 : 0;
    disk_.full = start % 3 == 0 ? 0.5 : 0;
    auto ledger = open();
    EXPECT_EQ(ledger.damage(), "") << start;
    for (const auto& [number, report] : kept) EXPECT_EQ(find_or_fail(ledger, number), report) << start;
    for (int step = 0; step < 40; ++step) {
      const Report report = backpack(start * 40 + step + 1);
      if (write(ledger, report)) kept[report.number] = report;
      const Report moved = in_state(report, ReportState::Sending);
      if (kept.contains(report.number) && write(ledger, moved, Flush::Soon)) {
        if (ledger.flush())
          kept[report.number] = moved;
        else if (write(ledger, moved))
          kept[report.number] = moved;
        else
          kept.erase(report.number);  // either result is allowed
      }
    }
    disk_.failing_syncs = disk_.failing_writes = disk_.full = 0;
    ledger = Ledger::make_closed("", {});
    if (start % 2 == 1) disk_.cut_power();
  }
  EXPECT_GT(kept.size(), 50u);
}

/// Damage is found while the disk is full: all records can be read, none is written. Once there is room,
/// the ledger continues as if there had been room at the start.
TEST_F(LedgerOnDisk, DamageOnAFullDiskIsReportedAndRepairedLater) {
  const LedgerFacts known{.reports = 20, .log = 7};
  LedgerFacts after;
  std::vector<Report> reports;
  {
    auto ledger = open();
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  disk_.full = 1;
  {
    auto ledger = open(known);
    EXPECT_THAT(ledger.damage(), HasSubstr("reports 2 to 20 are lost"));
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(ledger.make_ready());
    EXPECT_FALSE(write(ledger, in_state(backpack(1), ReportState::Withdrawn)));
    EXPECT_EQ(find_or_fail(ledger, 1).state, ReportState::InDoubt);
    EXPECT_GE(ledger.known_facts().reports, 20) << "the stamp floor must keep the number";
    EXPECT_GE(ledger.known_facts().log, 7u);
    EXPECT_FALSE(std::filesystem::exists(disk_.log() + "/damaged-2"))
        << "each try puts the files aside again";
    disk_.full = 0;
    EXPECT_TRUE(ledger.make_ready());
    EXPECT_EQ(ledger.refusal(), "");
    reports = ledger.reports();
    after = ledger.known_facts();
    EXPECT_GT(after.log, known.log) << "a name is used twice";
    expect_all(ledger);
  }
  const auto ledger = open(known);  // the stamps are 10 s old
  EXPECT_EQ(ledger.damage(), "");
  EXPECT_EQ(ledger.reports(), reports);
}

TEST_F(LedgerOnDisk, FailedSnapshotsLeaveNoFiles) {
  disk_.failing_file = "snapshot-";
  auto ledger = open({.reports = 20, .log = 7});
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(ledger.make_ready());
  EXPECT_THAT(ledger.refusal(), HasSubstr("Input/output error"));
  EXPECT_THAT(files_in(disk_.log()), SizeIs(1));
  disk_.failing_file = "";
  EXPECT_TRUE(ledger.make_ready());
  expect_all(ledger);
}

/// The process is killed anywhere in its handling of damage, with or without a power cut. The next start
/// reports the damage again, or has the result of the one before.
class LedgerKilledAtDamage : public testing::Test {
 protected:
  void play(const std::string& damage) {
    using enum ReportState;
    const State state;
    {
      auto ledger = open_or_fail(state.path());
      for (const auto& [number, next] :
           {std::pair(1, Queued), {1, Sending}, {2, Queued}, {3, Queued}, {3, Answered}, {4, Held}})
        ASSERT_TRUE(write(ledger, in_state(backpack(number), next)));
    }
    files_ = files_in(state.ledger());
    std::string& log = files_.begin()->second;
    if (damage == "cut") log.clear();
    if (damage == "gap") log[8192 + 60] ^= 1, log[8192 + 4096 + 60] ^= 1;
    if (damage == "gone") files_.clear();
    if (damage == "last" || damage == "gone") known_ = {.reports = 4, .log = 2};
    bool is_killed = true;
    for (std::size_t call = 1; is_killed; ++call) {
      SCOPED_TRACE(call);
      store::Disk disk(store::Random(call, "disk"), "ledger");
      for (const auto& [name, bytes] : files_)
        std::ofstream(disk.log() + '/' + name, std::ios::binary) << bytes;
      disk.kill_at = call;
      is_killed = false;
      try {
        EXPECT_NE(open_or_fail(disk.path(), known_).damage(), "");
      } catch (const store::Disk::Killed&) {
        is_killed = true;
      }
      if (call % 2 == 0) disk.cut_power();
      disk.kill_at = 0;
      disk.start();
      const auto ledger = open_or_fail(disk.path(), known_);
      EXPECT_THAT(files_in(disk.log()).rbegin()->first, testing::StartsWith("snapshot-"));
      EXPECT_GE(ledger.known_facts().reports, 4);
      EXPECT_GE(ledger.known_facts().log, known_.log);
      for (const Report& report : ledger.reports())
        ASSERT_EQ(report.state, report.number == 3 ? ReportState::Answered : ReportState::InDoubt)
            << report.number;
    }
  }

 private:
  Files files_;
  LedgerFacts known_;
};

TEST_F(LedgerKilledAtDamage, ReportsMissingRecordsAgain) {
  play("gap");
}
TEST_F(LedgerKilledAtDamage, ReportsATruncatedFileAgain) {
  play("cut");
}
TEST_F(LedgerKilledAtDamage, ReportsAMissingLastFileAgain) {
  play("last");
}
TEST_F(LedgerKilledAtDamage, ReportsAMissingDirectoryAgain) {
  play("gone");
}

}  // namespace
}  // namespace adit::ledger
