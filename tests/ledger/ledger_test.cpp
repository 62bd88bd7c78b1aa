#include "ledger/ledger.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ledger/folder.hpp"

namespace adit::ledger {
namespace {

using dispatch::ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

/// A report with something in every member.
dispatch::Report answered(std::int64_t number) {
  dispatch::Report report = backpack(number);
  report.changed = 12.5;
  report.state = ReportState::Answered;
  report.note = "scored";
  report.run = 3;
  report.asked = true;
  report.same_as = 2;
  report.tries = 4;
  report.sending = 17;
  report.sent = 12.25;
  report.before = icd::RunStatus{-5, 831.5, 19, "adit"};
  report.status = 201;
  report.content_type = "application/json";
  report.answer = R"({"score_change":1})";
  report.reconciled = true;
  return report;
}

TEST(Ledger, GivesBackAReportAsItWasGiven) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
    ASSERT_TRUE(write(ledger, answered(2)));
    EXPECT_THAT(*ledger.reports(), ElementsAre(backpack(1), answered(2)));
  }
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.damage(), "");
  EXPECT_THAT(*ledger.reports(), ElementsAre(backpack(1), answered(2)));
}

TEST(Ledger, KeepsTheRobotThatAReportNamesThroughAllItsSteps) {
  const Folder folder;
  dispatch::Report sent = named_backpack(1, "spot1");
  {
    auto ledger = open_or_fail(folder);
    const std::vector steps{named_backpack(1, "spot1"), sent};
    ASSERT_TRUE(ledger.write(steps));
    sent.state = ReportState::Sending;
    ASSERT_TRUE(write(ledger, sent));
    EXPECT_THAT(*ledger.reports(), ElementsAre(sent));
  }
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.damage(), "");
  EXPECT_THAT(*ledger.reports(), ElementsAre(sent));
  EXPECT_EQ(ledger.history(1)->size(), 3u);
}

TEST(Ledger, ReplacesAReportByItsLaterStep) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(write(ledger, backpack(1)));
  ASSERT_TRUE(write(ledger, answered(1)));
  EXPECT_THAT(*ledger.reports(), ElementsAre(answered(1)));
  dispatch::Report unknown = answered(1);
  unknown.before.reset();
  ASSERT_TRUE(write(ledger, unknown));
  EXPECT_THAT(*ledger.reports(), ElementsAre(unknown));
}

TEST(Ledger, ListsReportsOldestFirstWhateverTheOrderTheyWereWrittenIn) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  for (const int number : {11, 2, 1, 12, 3}) ASSERT_TRUE(write(ledger, backpack(number)));
  std::vector<std::int64_t> numbers;
  const auto reports = ledger.reports();
  ASSERT_TRUE(reports);
  for (const auto& report : *reports) numbers.push_back(report.number);
  EXPECT_THAT(numbers, ElementsAre(1, 2, 3, 11, 12));
}

TEST(Ledger, KeepsEveryStepOfAReportInOrder) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
    dispatch::Report report = backpack(2);
    std::vector<dispatch::Report> steps{report};
    for (const ReportState state : {ReportState::Sending, ReportState::InDoubt, ReportState::Settled}) {
      report.state = state;
      report.note = "now " + std::string(dispatch::shown_name_of(state));
      report.changed -= 1;  // a clock that was set back does not change the order
      steps.push_back(report);
    }
    ASSERT_TRUE(ledger.write(steps)) << "several steps of one report in one transaction";
    EXPECT_EQ(find_or_fail(ledger, 2), steps.back());
  }
  const auto ledger = open_or_fail(folder);
  EXPECT_THAT(*ledger.history(2),
              ElementsAre(Ledger::Step{2, 10, "queued", ""}, Ledger::Step{2, 9, "sending", "now sending"},
                          Ledger::Step{2, 8, "in_doubt", "now in doubt"},
                          Ledger::Step{2, 7, "settled", "now settled"}));
  EXPECT_TRUE(ledger.history(7)->empty());
}

TEST(Ledger, KeepsEveryStateThereIs) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  for (auto state = ReportState::Held;; state = static_cast<ReportState>(static_cast<int>(state) + 1)) {
    dispatch::Report report = backpack(1);
    report.state = state;
    ASSERT_TRUE(write(ledger, report));
    EXPECT_EQ(find_or_fail(ledger, 1).state, state);
    if (state == ReportState::Withdrawn) break;
  }
}

TEST(Ledger, ReadsAStateItDoesNotKnowAsInDoubtAndShowsItsWordInTheHistory) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  by_hand(folder,
          "UPDATE report SET state = 'promised', history = replace(history, '7:waiting', '8:promised')");
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(find_or_fail(ledger, 1).state, ReportState::InDoubt);
  EXPECT_EQ(ledger.history(1)->at(0).state, "promised");
}

TEST(Ledger, SaysWhichReportsHistoryIsDamaged) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  for (const char* history :
       {"x", "10", "10 7:waiting", "10 7:waiting 0:", "10 70:waiting 0:\n", "10 -1: 0:\n"}) {
    by_hand(folder, "UPDATE report SET history = '" + std::string(history) + "'");
    const auto ledger = open_or_fail(folder);
    const auto read = ledger.history(1);
    ASSERT_FALSE(read) << history;
    EXPECT_EQ(read.error().what, "reading the history of report 1: it is damaged");
    EXPECT_EQ(find_or_fail(ledger, 1), backpack(1));
  }
}

TEST(Ledger, WritesAllStepsOrNone) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(write(ledger, backpack(1)));
  const std::vector<dispatch::Report> steps{backpack(2), answered(1), backpack(0), backpack(3)};
  const auto written = ledger.write(steps);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().what, HasSubstr("report 0"));
  EXPECT_NE(written.error().kind, Error::Kind::Full);
  EXPECT_THAT(*ledger.reports(), ElementsAre(backpack(1)));
  EXPECT_EQ(ledger.history(1)->size(), 1u);
  EXPECT_TRUE(write(ledger, backpack(2))) << "the failed steps still hold their transaction";
}

TEST(Ledger, WritesNothingWhereThereIsNothingToWrite) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  EXPECT_TRUE(ledger.write(std::span<const dispatch::Report>()));
  EXPECT_TRUE(ledger.reports()->empty());
}

TEST(Ledger, NeverPutsAReportInThePlaceOfAnother) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(write(ledger, backpack(1)));
  dispatch::Report drill = backpack(1), elsewhere = backpack(1, 7), later = backpack(1);
  drill.report.type = "Drill";
  later.received = 11;
  for (const auto& other : {drill, elsewhere, later}) {
    const auto written = write(ledger, other);
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().what, HasSubstr("another report has this number"));
  }
  EXPECT_THAT(*ledger.reports(), ElementsAre(backpack(1)));
  EXPECT_EQ(ledger.history(1)->size(), 1u);
}

TEST(Ledger, KeepsAllRunsAndWhatWasHeardInThem) {
  const Folder folder;
  dispatch::Run first{1, "", 5, "the first status", std::nullopt, 0, ""};
  dispatch::Run second{2,
                       "1.5.2",
                       900,
                       "its clock ran backward",
                       icd::RunStatus{7, 0.5, 25, "adit"},
                       901,
                       "a:1",
                       "somebody else reports too",
                       3,
                       1,
                       dispatch::Clock{0.5, true},
                       dispatch::Clock{3.14, false}};
  {
    auto ledger = open_or_fail(folder);
    EXPECT_THAT(*ledger.runs(), ElementsAre());
    ASSERT_TRUE(ledger.write(first));
    EXPECT_THAT(*ledger.runs(), ElementsAre(first));
    ASSERT_TRUE(ledger.write(second));
    first.id = "1";
    ASSERT_TRUE(ledger.write(first)) << "also an earlier one may change";
    EXPECT_THAT(*ledger.runs(), ElementsAre(first, second));
  }
  auto ledger = open_or_fail(folder);
  EXPECT_THAT(*ledger.runs(), ElementsAre(first, second));
  second.last.reset();
  second.status_clock.reset();
  second.may_be = 0;
  ASSERT_TRUE(ledger.write(second));
  EXPECT_THAT(*ledger.runs(), ElementsAre(first, second));
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
  std::int64_t number = 0;
  for (const auto& text : hostile) {
    dispatch::Report report = backpack(++number);
    report.report = {text, {0, -0.0, 1e308}};
    report.sender = report.note = report.content_type = report.answer = text;
    report.before = icd::RunStatus{std::numeric_limits<std::int64_t>::min(), -1e308,
                                   std::numeric_limits<std::int64_t>::max(), text};
    ASSERT_TRUE(write(ledger, report));
    EXPECT_EQ(find_or_fail(ledger, number), report);
    EXPECT_EQ(ledger.history(number)->at(0).note, text);
    const dispatch::Run run{number, text, 0, text, report.before, 0, text};
    ASSERT_TRUE(ledger.write(run));
    EXPECT_EQ(ledger.runs()->back(), run);
  }
}

TEST(Ledger, RefusesWhatIsNoNumber) {
  const Folder folder;
  auto ledger = open_or_fail(folder);
  dispatch::Report report = backpack(1);
  report.before = icd::RunStatus{0, std::nan(""), 0, ""};
  EXPECT_FALSE(write(ledger, report)) << "a status without its clock is not one";
  EXPECT_FALSE(write(ledger, backpack(1, std::nan(""))));
  EXPECT_FALSE(ledger.write(dispatch::Run{1, "", 0, "", icd::RunStatus{0, std::nan(""), 0, ""}, 0, ""}));
  EXPECT_FALSE(ledger.write(dispatch::Run{.number = 0}));
  EXPECT_TRUE(ledger.reports()->empty());
  EXPECT_THAT(*ledger.runs(), ElementsAre());
}

TEST(Ledger, IsReadableByItsOwnerAlone) {
  const Folder folder;
  const mode_t before = ::umask(0);
  auto ledger = open_or_fail(folder);
  ::umask(before);
  ASSERT_TRUE(write(ledger, backpack(1)));
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

TEST(Ledger, SaysWhichFolderIsMissing) {
  const Folder folder;
  const auto ledger = Ledger::open(folder.text() + "/absent");
  ASSERT_FALSE(ledger);
  EXPECT_THAT(ledger.error().what, HasSubstr("/absent: No such file"));
}

}  // namespace
}  // namespace adit::ledger
