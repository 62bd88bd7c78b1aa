// A copy of a ledger, and a take-over of another box's ledger.
#include "ledger/state.hpp"

namespace adit::ledger {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

Report queued(std::int64_t number, double x) {
  Report report = backpack(number, x);
  report.received = report.changed = 10 + x;
  return report;
}

Report answered(Report report) {
  report.changed += 1;
  report.state = ReportState::Answered;
  report.sending = report.number;
  report.status = 201;
  report.answer = R"({"report_status": "scored"})";
  return report;
}

const dispatch::Run kRun{
    .number = 1, .began = 5, .why = "a first one", .heard = 9, .post = "10.100.1.200:8000"};

TEST(LedgerOfATakeOver, HasEachReportWithItsHistory) {
  const State first, spare;
  auto there = open_or_fail(first.path());
  ASSERT_TRUE(there.write(kRun));
  ASSERT_TRUE(write(there, queued(1, 1)));
  ASSERT_TRUE(write(there, answered(queued(1, 1))));
  Report named = queued(2, 2);
  named.report.robot = icd::RobotName::parse("spot1");
  ASSERT_TRUE(write(there, named));
  {
    auto here = open_or_fail(spare.path());
    ASSERT_TRUE(here.write(kRun));
    ASSERT_TRUE(write(here, queued(1, 7)));
    const std::string copy = there.copy().value();
    EXPECT_TRUE(Ledger::is_copy(copy));
    ASSERT_TRUE(here.take_over(copy, {.stamp = 50}));
    ASSERT_TRUE(here.take_over(copy, {.stamp = 60})) << "a second take-over changes nothing";
    EXPECT_FALSE(here.take_over(copy.substr(1), {.stamp = 50}));
  }
  const auto here = open_or_fail(spare.path());
  EXPECT_EQ(here.damage(), "");
  EXPECT_THAT(here.reports(), SizeIs(3));
  EXPECT_EQ(find_or_fail(here, 2).answer, answered(queued(1, 1)).answer);
  EXPECT_THAT(here.history(2), ElementsAre(Step{11, "queued", ""}, Step{12, "answered", ""}));
  EXPECT_EQ(find_or_fail(here, 3).report, named.report);
  const auto steps = here.history(3);
  ASSERT_THAT(steps, SizeIs(2));
  EXPECT_EQ(steps[1].state, "in_doubt");
  EXPECT_THAT(steps[1].note, HasSubstr("the first box"));
}

}  // namespace
}  // namespace adit::ledger
