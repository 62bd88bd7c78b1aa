// A ledger that is copied, and one that another box's is taken over into.
#include <gmock/gmock.h>

#include "ledger/folder.hpp"
#include "ledger/ledger.hpp"

namespace adit::ledger {
namespace {

using dispatch::ReportState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

dispatch::Report waiting(std::int64_t number, double x) {
  dispatch::Report report = backpack(number, x);
  report.received = report.changed = 10 + x;
  report.run = 1;
  return report;
}

dispatch::Report answered(dispatch::Report report) {
  report.changed += 1;
  report.state = ReportState::Answered;
  report.sending = report.number;
  report.status = 201;
  report.answer = R"({"report_status": "scored"})";
  return report;
}

dispatch::Run run_at(const std::string& post) {
  return {.number = 1, .began = 5, .why = "a first one", .heard = 9, .post = post};
}

/// As the other box would have it from an export.
void carry(const Ledger& from, const Folder& to) {
  const auto bytes = from.copy();
  ASSERT_TRUE(bytes) << bytes.error().what;
  save(to.file(), *bytes);
}

TEST(LedgerThatIsCopied, HasAllThatWasWrittenWhileItIsOpen) {
  const Folder folder, other;
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(ledger.write(run_at("here")));
  for (int number = 1; number <= 200; ++number) ASSERT_TRUE(write(ledger, waiting(number, number)));
  carry(ledger, other);
  const auto copy = open_or_fail(other);
  EXPECT_EQ(copy.damage(), "");
  EXPECT_EQ(*copy.reports(), *ledger.reports());
  EXPECT_EQ(*copy.runs(), *ledger.runs());
}

TEST(LedgerThatTakesOver, HasEachReportWithItsHistoryAlsoAfterAnEnd) {
  const Folder first, copy, spare;
  auto there = open_or_fail(first);
  ASSERT_TRUE(there.write(run_at("10.100.1.200:8000")));
  ASSERT_TRUE(write(there, waiting(1, 1)));
  ASSERT_TRUE(write(there, answered(waiting(1, 1))));
  dispatch::Report named = waiting(2, 2);
  named.report.robot = icd::RobotName::parse("spot1");
  ASSERT_TRUE(write(there, named));
  carry(there, copy);
  {
    auto here = open_or_fail(spare);
    ASSERT_TRUE(here.write(run_at("10.100.1.200:8000")));
    ASSERT_TRUE(write(here, waiting(1, 7)));
    ASSERT_TRUE(here.take_over(open_or_fail(copy), {.stamp = 50}));
  }
  const auto here = open_or_fail(spare);
  EXPECT_EQ(here.damage(), "");
  EXPECT_THAT(*here.reports(), SizeIs(3));
  EXPECT_EQ(find_or_fail(here, 2).answer, answered(waiting(1, 1)).answer);
  EXPECT_EQ(find_or_fail(here, 3).report, named.report);
  EXPECT_THAT(*here.history(2),
              ElementsAre(Ledger::Step{2, 11, "queued", ""}, Ledger::Step{2, 12, "answered", ""}));
  const auto steps = *here.history(3);
  ASSERT_THAT(steps, SizeIs(2));
  EXPECT_EQ(steps[1].state, "in_doubt");
  EXPECT_THAT(steps[1].note, HasSubstr("the first box"));
}

TEST(LedgerThatTakesOver, IsAsItWasWhereItCannotBeWritten) {
  const Folder first, copy, spare, scratch;
  auto there = open_or_fail(first);
  ASSERT_TRUE(write(there, waiting(1, 1)));
  carry(there, copy);
  {
    ASSERT_TRUE(write(*std::make_unique<Ledger>(open_or_fail(spare)), waiting(1, 7)));
  }
  auto here = Ledger::stand_in(spare.text(), scratch.text(), "the disk is full");
  ASSERT_TRUE(here);
  EXPECT_FALSE(here->take_over(open_or_fail(copy), {.stamp = 50}));
  EXPECT_THAT(*here->reports(), SizeIs(1));
}

TEST(LedgerThatIsCopied, IsNoneWhereWhatItStandsInForCannotBeRead) {
  const Folder first, scratch;
  ASSERT_TRUE(write(*std::make_unique<Ledger>(open_or_fail(first)), waiting(1, 1)));
  const auto readable = Ledger::stand_in(first.text(), scratch.text(), "the disk is full");
  ASSERT_TRUE(readable);
  EXPECT_TRUE(readable->copy());
  std::filesystem::remove(first / "ledger.sqlite");
  std::filesystem::create_directory(first / "ledger.sqlite");
  const auto unread = Ledger::stand_in(first.text(), scratch.text(), "the disk reports errors");
  ASSERT_TRUE(unread);
  const auto copy = unread->copy();
  ASSERT_FALSE(copy) << "a spare would take it for all there was";
  EXPECT_THAT(copy.error().what, HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace adit::ledger
