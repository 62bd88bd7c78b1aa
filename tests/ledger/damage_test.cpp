// Damaged, cut, missing or old files of a ledger: the ledger uses the rest and reports the loss.
#include <array>
#include <functional>

#include "ledger/book.hpp"
#include "ledger/state.hpp"
#include "store/directory.hpp"

namespace adit::ledger {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::size_t kRecord = 8192;  // bytes of a short record: two copies of a frame, 4 KiB each

/// A ledger of one file with one record for each of these.
class DamagedLedger : public testing::Test {
 protected:
  void SetUp() override {
    using enum ReportState;
    auto ledger = open_or_fail(state_.path());
    ASSERT_TRUE(ledger.write(dispatch::Run{.number = 1, .began = 5}));  // record 1
    for (const auto& [number, state] : {std::pair(1, Queued),
                                        {1, Sending},
                                        {1, Answered},
                                        {2, Queued},
                                        {3, Held},
                                        {2, Withdrawn},
                                        {4, Queued},
                                        {4, Sending}})
      ASSERT_TRUE(write(ledger, in_state(backpack(number), state)));
    known_ = ledger.known_facts();
    all_ = ledger.reports();
    files_ = files_in(state_.ledger());
    file_ = files_.begin()->first;
  }

  void restore() const { put_files(state_.ledger(), files_); }
  void put(const std::string& bytes) const { put_files(state_.ledger(), {{file_, bytes}}); }
  std::string& log() { return files_.at(file_); }
  /// Damages both copies of a record.
  static void damage(std::string& log, std::size_t record, std::size_t byte = 60) {
    for (const std::size_t copy : {std::size_t{0}, kRecord / 2}) log.at(record * kRecord + copy + byte) ^= 1;
  }

  /// The next start reports the missing records, sends no report again, and reuses no number. The start
  /// after it reports nothing.
  void expect_said(const LedgerFacts& known, const std::string& sentence = "") const {
    std::vector<Report> reports;
    LedgerFacts after;
    {
      const auto ledger = open_or_fail(state_.path(), known);
      EXPECT_THAT(ledger.damage(), AllOf(HasSubstr("The ledger was damaged"), HasSubstr(sentence)));
      EXPECT_EQ(ledger.refusal(), "");
      reports = ledger.reports();
      after = ledger.known_facts();
    }
    EXPECT_GE(after.reports, known_.reports);
    EXPECT_GT(after.log, known.log);
    expect_safe(reports);
    const auto again = open_or_fail(state_.path(), after);
    EXPECT_EQ(again.damage(), "");
    EXPECT_EQ(again.reports(), reports);
    EXPECT_FALSE(again.runs().at(0).unreliable.empty());
  }
  /// Checks that each report is there or replaced by a lost one, and that each report that was not final is
  /// in doubt.
  void expect_safe(const std::vector<Report>& reports) const {
    for (const Report& was : all_) {
      const auto is =
          std::ranges::find_if(reports, [&](const Report& each) { return each.number >= was.number; });
      ASSERT_NE(is, reports.end()) << was.number;
      if (is->number != was.number) EXPECT_TRUE(is->is_lost()) << was.number;
    }
    for (const Report& report : reports) {
      const bool is_as_it_was = std::ranges::find(all_, report) != all_.end();
      EXPECT_TRUE(report.state == ReportState::InDoubt ||
                  (is_as_it_was && (report.number == 1 || report.number == 2)))
          << report.number;
    }
  }

  State state_;
  LedgerFacts known_;
  std::vector<Report> all_;
  Files files_;
  std::string file_;
};

TEST_F(DamagedLedger, HasAllIfOneCopyOfARecordIsDamaged) {
  for (std::size_t record = 0; record <= 9; ++record) {
    SCOPED_TRACE(record);
    for (const std::size_t copy : {0, 1}) {
      std::string bytes = log();
      bytes.at(record * kRecord + copy * kRecord / 2 + 60) ^= 1;
      put(bytes);
      const auto ledger = open_or_fail(state_.path(), known_);
      const bool is_said =
          record != 0 && record != 9;  // a header has no report; a power cut may have torn the last record
      EXPECT_EQ(!ledger.damage().empty(), is_said) << ledger.damage();
      if (is_said)
        EXPECT_THAT(ledger.damage(), AllOf(HasSubstr("repaired"), HasSubstr("No report is missing")));
      EXPECT_EQ(ledger.reports(), all_);
      EXPECT_EQ(files_in(state_.ledger()), files_) << "the damaged copy must not change";
    }
  }
}

TEST_F(DamagedLedger, NamesLostReportsIfBothCopiesAreDamaged) {
  for (std::size_t record = 1; record <= 8; ++record) {
    SCOPED_TRACE(record);
    std::string bytes = log();
    damage(bytes, record);
    put(bytes);
    expect_said({});
    EXPECT_EQ(files_in(state_.ledger() + "/damaged-1").at(file_).size(), bytes.size());
  }
  std::string bytes = log();
  damage(bytes, 8), damage(bytes, 9);
  put(bytes);
  expect_said(known_, "report 4 is lost from the ledger; reports may be missing from number 5 on");
}

/// One flipped bit in any byte loses no record.
TEST_F(DamagedLedger, HasAllIfAnyByteIsDamaged) {
  const auto directory = store::Directory::open(state_.ledger()).value();
  const std::string path = state_.ledger() + '/' + file_;
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto put_byte = [&](std::size_t at, char byte) {
    file.seekp(static_cast<std::streamoff>(at));
    file.put(byte).flush();
  };
  for (std::size_t at = 0; at < 10 * kRecord; at += log()[at] == 0 ? 509 : 19) {
    put_byte(at, static_cast<char>(log()[at] ^ (1 << at % 8)));
    const auto reading = read(store::Contents::read(directory, Ledger::kKeeping).value()).value();
    ASSERT_EQ(reading.gap, "") << at;
    ASSERT_EQ(reading.book.reports(), all_) << at;
    put_byte(at, log()[at]);
  }
}

TEST_F(DamagedLedger, ReportsATruncatedFile) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, kRecord, 3 * kRecord + 100, 9 * kRecord,
                                 10 * kRecord, log().size() - 1}) {
    SCOPED_TRACE(size);
    put(log().substr(0, size));
    expect_said({}, "may be missing");
    put(log().substr(0, size));
    expect_said(known_, "may be missing");
  }
}

TEST_F(DamagedLedger, ReportsAMissingDirectory) {
  std::filesystem::remove_all(state_.ledger());
  expect_said(known_,
              "0 reports were read; reports 1 to 4 are lost from the ledger; reports may be missing from "
              "number 5 on");
  EXPECT_FALSE(std::filesystem::exists(state_.ledger() + "/damaged-1")) << "there is no file to keep";
  std::filesystem::remove_all(state_.ledger());
  EXPECT_EQ(open_or_fail(state_.path()).damage(), "") << "no damage is known";
}

TEST_F(DamagedLedger, ReportsAnOldCopyInItsPlace) {
  expect_said({.reports = 6, .log = 1},
              "reports 5 to 6 are lost from the ledger; reports may be missing from number 7 on");
  EXPECT_THAT(files_in(state_.ledger() + "/damaged-1"), testing::Contains(testing::Key(file_)));
}

/// Of the same files, before the last steps of known reports.
TEST_F(DamagedLedger, ReportsAnOlderCopyWithoutItsLastSteps) {
  for (const std::size_t record : {4, 7, 8}) {
    SCOPED_TRACE(record);
    const std::string memory = state_.path() + "/memory-" + std::to_string(record);
    restore();
    ASSERT_EQ(open_or_fail(state_.path(), known_, memory).damage(), "");
    std::string older = log();
    std::fill(older.begin() + static_cast<std::ptrdiff_t>(record * kRecord), older.end(), '\0');
    put(older);
    expect_said({.last = record}, "may be missing");
    put(older);
    const auto ledger = open_or_fail(state_.path(), {}, memory);
    EXPECT_THAT(ledger.damage(),
                AllOf(HasSubstr("its last records are not there"), Not(HasSubstr("may be"))));
    expect_safe(ledger.reports());
  }
}

/// A record that was accepted but not synced may be lost in a power cut.
TEST_F(DamagedLedger, IsNoLedgerThatLacksAnUnsyncedRecord) {
  std::string older = log();
  {
    auto ledger = open_or_fail(state_.path(), known_);
    const LedgerFacts before = ledger.known_facts();
    const Report settled = in_state(backpack(3), ReportState::Queued);
    ASSERT_TRUE(ledger.write({&settled, 1}, nullptr, dispatch::Flush::Soon));
    EXPECT_EQ(ledger.known_facts(), before);
    known_ = ledger.known_facts();
  }
  put(older);
  EXPECT_EQ(open_or_fail(state_.path(), known_).damage(), "");
}

/// So they also belong to the run that the next status shows, if the earlier run was heard last before the
/// damage.
TEST_F(DamagedLedger, MayHaveSentReportsAfterTheLastWordOfTheRun) {
  ASSERT_TRUE(open_or_fail(state_.path(), known_).write(dispatch::Run{.number = 1, .began = 5, .heard = 90}));
  const auto ledger = open_or_fail(state_.path(), {.reports = 6, .log = 1});
  for (const std::int64_t number : {3, 4, 6}) {
    ASSERT_EQ(find_or_fail(ledger, number).state, ReportState::InDoubt);
    EXPECT_GE(find_or_fail(ledger, number).sent, 90) << number;
  }
}

TEST_F(DamagedLedger, ReportsAMissingLastFile) {
  expect_said({.reports = known_.reports, .log = 2}, "reports may be missing from number 5 on");
}

TEST_F(DamagedLedger, NamesTheMissingFileOfSeveral) {
  turn_log(state_.ledger());
  {
    auto ledger = open_or_fail(state_.path());
    ASSERT_TRUE(write(ledger, in_state(backpack(4), ReportState::InDoubt)));
    all_ = ledger.reports();
  }
  turn_log(state_.ledger());
  files_ = files_in(state_.ledger());
  ASSERT_EQ(files_.size(), 3u);
  const LedgerFacts known{.reports = 4, .log = 3};
  for (const auto& [name, bytes] : files_) {
    SCOPED_TRACE(name);
    Files left = files_;
    left.erase(name);
    put_files(state_.ledger(), left);
    expect_said(known);
  }
}

/// The first snapshot replaces files that still exist. Later snapshots have one before them.
TEST_F(DamagedLedger, HasAllIfASnapshotIsDamagedOrMissing) {
  for (int snapshot = 1; snapshot <= 2; ++snapshot) {
    turn_log(state_.ledger());
    (void)open_or_fail(state_.path());
    turn_log(state_.ledger());
    auto ledger = open_or_fail(state_.path());
    (void)fill_file(ledger, ledger.known_facts().reports + 1);
    ASSERT_TRUE(keep_up(ledger));
    known_ = ledger.known_facts();
    all_ = ledger.reports();
    files_ = files_in(state_.ledger());
    const std::string name = files_.rbegin()->first;
    ASSERT_TRUE(name.starts_with("snapshot-"));
    for (const bool is_missing : {false, true}) {
      Files damaged = files_;
      damaged.at(name).assign(damaged.at(name).size(), 'x');
      if (is_missing) damaged.erase(name);
      ledger = Ledger::make_closed("", {});
      put_files(state_.ledger(), damaged);
      const auto again = open_or_fail(state_.path(), known_);
      EXPECT_THAT(again.damage(), HasSubstr(is_missing ? "" : "a damaged snapshot. No report is missing"));
      EXPECT_THAT(again.damage(), testing::Not(HasSubstr("The ledger was damaged")));
      EXPECT_EQ(again.reports(), all_);
    }
    restore();
  }
}

TEST_F(DamagedLedger, ReportsAnUnknownRecord) {
  append(state_.ledger(), 1, "no steps");
  expect_said(known_, "record 10 cannot be understood");
}

TEST_F(DamagedLedger, ReportsLaterDamage) {
  std::string bytes = log();
  damage(bytes, 5);
  put(bytes);
  {
    auto ledger = open_or_fail(state_.path());
    ASSERT_TRUE(write(ledger, backpack(ledger.known_facts().reports + 1)));
  }
  auto files = files_in(state_.ledger());
  for (auto& [name, each] : files) {
    if (!name.starts_with("snapshot-")) each.resize(each.size() / 2);
  }
  put_files(state_.ledger(), files);
  const auto ledger = open_or_fail(state_.path());
  EXPECT_THAT(ledger.damage(), HasSubstr("may be missing"));
  EXPECT_EQ(find_or_fail(ledger, 1).state, ReportState::Answered);
}

}  // namespace
}  // namespace adit::ledger
