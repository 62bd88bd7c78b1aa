#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include "ledger/folder.hpp"

namespace adit::ledger {
namespace {

using testing::HasSubstr;

/// A whole ledger of some pages.
std::string healthy_bytes() {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    for (int number = 1; number <= 200; ++number) EXPECT_TRUE(write(ledger, backpack(number)));
  }
  return bytes_of(folder.file());
}

/// That the file was set aside whole, that what is not in the new ledger is said to be lost, and that it
/// works. How many reports were taken over.
std::size_t expect_set_aside(const Folder& folder, const std::string& bytes) {
  auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), HasSubstr(folder.file() + ".damaged-1"));
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-1"), bytes);
  std::size_t taken_over = 0;
  std::int64_t next = 1;
  const auto reports = *ledger.reports();
  for (const dispatch::Report& report : reports) {
    if (report.is_lost()) {
      EXPECT_EQ(report.state, dispatch::ReportState::InDoubt);
      EXPECT_THAT(ledger.damage(), HasSubstr(report.note.substr(0, report.note.find(':'))));
    } else {
      EXPECT_EQ(report.number, next) << "one is missing without a word";
      EXPECT_EQ(report.report, backpack(report.number).report);
      ++taken_over;
    }
    next = report.number + 1;
  }
  EXPECT_TRUE(write(ledger, backpack(next)));
  return taken_over;
}

TEST(DamagedLedger, IsSetAsideWhenItIsRandomBytes) {
  std::mt19937_64 random(1);
  std::string bytes(20000, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  const Folder folder;
  save(folder.file(), bytes);
  EXPECT_EQ(expect_set_aside(folder, bytes), 0u);
}

TEST(DamagedLedger, IsSetAsideWhenItIsTruncated) {
  const std::string healthy = healthy_bytes();
  for (const std::size_t size :
       {std::size_t{50}, std::size_t{4096}, healthy.size() * 3 / 4, healthy.size() - 4096}) {
    const Folder folder;
    save(folder.file(), healthy.substr(0, size));
    SCOPED_TRACE(size);
    EXPECT_EQ(expect_set_aside(folder, healthy.substr(0, size)) > 0, size > 5000) << "what can be had is had";
  }
}

TEST(DamagedLedger, IsSetAsideWhenAPageIsOverwritten) {
  std::string bytes = healthy_bytes();
  constexpr std::size_t kPage = 4096;
  ASSERT_GT(bytes.size(), 3 * kPage);
  for (std::size_t i = kPage; i < 3 * kPage; ++i) bytes[i] = '\xa5';
  const Folder folder;
  save(folder.file(), bytes);
  EXPECT_GT(expect_set_aside(folder, bytes), 100u);
}

TEST(DamagedLedger, IsSetAsideWhenItIsAnotherProgramsDatabase) {
  const Folder folder;
  by_hand(folder, "CREATE TABLE report(number INTEGER); PRAGMA user_version = 9");
  auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), HasSubstr("another program's"));
  EXPECT_TRUE(ledger.reports()->at(0).is_lost()) << "what was there before it is not known";
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
    const auto ledger = open_or_fail(folder);
    EXPECT_THAT(ledger.damage(), HasSubstr("reports from 1 on may be lost")) << bytes.size();
    EXPECT_TRUE(ledger.reports()->at(0).is_lost());
  }
}

/// A row that is still a row, and says something else: nothing but its proof tells.
TEST(DamagedLedger, TakesNoRowThatIsNotAsItWasWritten) {
  std::string bytes = healthy_bytes();
  const std::size_t sender = bytes.rfind("10.0.0.7");
  ASSERT_NE(sender, std::string::npos);
  bytes[sender + 7] = '8';
  const Folder folder;
  save(folder.file(), bytes);
  EXPECT_EQ(expect_set_aside(folder, bytes), 199u);
}

TEST(SalvagedLedger, TakesItsPlaceAlsoWhereTheBoxDiedJustBefore) {
  const Folder folder, salvaged;
  {
    auto ledger = open_or_fail(salvaged);
    ASSERT_TRUE(write(ledger, backpack(7)));
  }
  save(folder.file(), "a damaged one");
  save(folder.file() + "-wal", "its log");
  std::filesystem::copy(salvaged.file(), folder.file() + ".salvaged");
  {
    const auto ledger = open_or_fail(folder);
    EXPECT_NE(ledger.damage(), "");
    EXPECT_EQ(ledger.reports()->size(), 1u);
  }
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-1"), "a damaged one");
  EXPECT_EQ(bytes_of(folder.file() + ".damaged-1-wal"), "its log");
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

TEST(SalvagedLedger, HoldsWhatMayHaveBeenSentSince) {
  std::string bytes;
  {
    const Folder folder;
    {
      auto ledger = open_or_fail(folder);
      for (int number = 1; number <= 8; ++number) {
        dispatch::Report report = backpack(number);
        report.run = 1;
        report.state = static_cast<dispatch::ReportState>(number - 1);
        report.before = icd::RunStatus{1, 2, 3, "adit"};
        if (number == 3) report.report.robot = icd::RobotName::parse("spot1");
        ASSERT_TRUE(write(ledger, report));
      }
    }
    bytes = bytes_of(folder.file());
  }
  bytes[69] = 'X';  // the application's number
  const Folder folder;
  save(folder.file(), bytes);
  {
    const auto ledger = open_or_fail(folder);
    const auto reports = *ledger.reports();
    for (const dispatch::Report& report : reports) {
      EXPECT_EQ(report.report.robot ? report.report.robot->text() : "", report.number == 3 ? "spot1" : "");
      using enum dispatch::ReportState;
      const auto was = static_cast<dispatch::ReportState>(report.number - 1);
      const bool is_settled = was == Answered || was == Settled || was == Withdrawn;
      EXPECT_EQ(report.state, is_settled ? was : InDoubt) << report.number;
      EXPECT_EQ(report.before.has_value(), is_settled) << "only the operator can judge it";
      EXPECT_EQ(ledger.history(report.number)->size(), is_settled ? 1u : 2u);
    }
    EXPECT_EQ(reports.size(), 8u);
    EXPECT_NE(ledger.runs()->back().unreliable, "");
  }
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

/// Any of them may be taken up again.
TEST(SalvagedLedger, KeepsAllRunsWithWhatTellsThemApartAndTrustsNoneOfTheirCounts) {
  dispatch::Run first{.number = 1,
                      .post = "a:1",
                      .turn = 3,
                      .status_clock = dispatch::Clock{25.98, false},
                      .answer_clock = dispatch::Clock{3.14, true}};
  dispatch::Run second{.number = 2, .post = "b:1", .turn = 2, .may_be = 1};
  std::string bytes;
  {
    const Folder folder;
    {
      auto ledger = open_or_fail(folder);
      ASSERT_TRUE(write(ledger, backpack(1)));
      ASSERT_TRUE(write(ledger, backpack(3)));
      ASSERT_TRUE(ledger.write(first));
      ASSERT_TRUE(ledger.write(second));
    }
    bytes = bytes_of(folder.file());
  }
  bytes[69] = 'X';  // the application's number
  const Folder folder;
  save(folder.file(), bytes);
  const auto ledger = open_or_fail(folder);
  auto runs = *ledger.runs();
  ASSERT_EQ(runs.size(), 2u);
  for (dispatch::Run& run : runs) EXPECT_NE(std::exchange(run.unreliable, ""), "") << run.number;
  EXPECT_EQ(runs[0], first);
  EXPECT_EQ(runs[1], second);
  EXPECT_TRUE(find_or_fail(ledger, 2).is_lost());
  EXPECT_EQ(find_or_fail(ledger, 2).run, 1) << "which was the present one last";
}

TEST(ADamagedNameOfARobot, ShowsByItsProofAndIsLeftOut) {
  std::string bytes;
  {
    const Folder folder;
    {
      auto ledger = open_or_fail(folder);
      ASSERT_TRUE(write(ledger, named_backpack(1, "spot1")));
    }
    bytes = bytes_of(folder.file());
  }
  const std::size_t at = bytes.rfind("spot1");
  ASSERT_NE(at, std::string::npos);
  bytes[at + 4] = '2';
  const Folder folder;
  save(folder.file(), bytes);
  const auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), testing::HasSubstr("the robot of report 1 is damaged"));
  EXPECT_EQ(find_or_fail(ledger, 1).report, backpack(1).report);
}

TEST(ADamagedSighting, ShowsByItsProof) {
  std::string bytes;
  {
    const Folder folder;
    {
      auto ledger = open_or_fail(folder);
      ASSERT_TRUE(ledger.write(dispatch::Run{.number = 1, .status_clock = dispatch::Clock{12345.678, true}}));
    }
    bytes = bytes_of(folder.file());
  }
  const double clock = 12345.678;
  std::string big_endian(sizeof clock, 0);
  std::memcpy(big_endian.data(), &clock, sizeof clock);
  std::ranges::reverse(big_endian);
  const std::size_t at = bytes.rfind(big_endian);
  ASSERT_NE(at, std::string::npos);
  bytes[at + 3] ^= 1;
  const Folder folder;
  save(folder.file(), bytes);
  const auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), testing::HasSubstr("the status of run 1 is damaged"));
  EXPECT_EQ(ledger.runs()->at(0).status_clock, std::nullopt) << "what is not known proves nothing";
}

TEST(BlankLedger, IsNotANewOne) {
  const Folder folder;
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

}  // namespace
}  // namespace adit::ledger
