#include "dispatch/report_book.hpp"

#include <gmock/gmock.h>

#include <array>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::IsEmpty;

class ReportBookTest : public testing::Test {
 protected:
  std::int64_t add(std::vector<ReportEvent> events = {}) {
    Report report;
    report.report = {"Drill", {1, 2, 3}};
    return book_.add(report, events, "");
  }
  FakeOutput output_;
  ReportBook book_{output_};
};

TEST_F(ReportBookTest, NumbersReportsAcrossARestart) {
  EXPECT_EQ(add(), 1);
  EXPECT_EQ(add(), 2);
  ReportBook again(output_);
  again.open({book_.at(1), book_.at(2)});
  EXPECT_EQ(again.add(Report(), {}, ""), 3);
}

TEST_F(ReportBookTest, WritesAReportAndItsSendingAtOnce) {
  add({ReportEvent::Chosen});
  EXPECT_EQ(output_.writes, 1);
  EXPECT_THAT(output_.states[1], ElementsAre(Queued, Sending));
  EXPECT_EQ(book_.at(1).state, Sending);
}

TEST_F(ReportBookTest, HasNoReportIfItsWriteFailed) {
  output_.full = true;
  EXPECT_EQ(add(), 0);
  EXPECT_THAT(book_.all(), IsEmpty());
  output_.full = false;
  EXPECT_EQ(add(), 1);
}

TEST_F(ReportBookTest, RejectsAStepOutsideTheTable) {
  add();
  EXPECT_FALSE(book_.move({1, ReportEvent::Found}, {}));
  EXPECT_EQ(book_.at(1).state, Queued);
  EXPECT_EQ(output_.writes, 1);
}

/// True in `taken` if the step is accepted though its write fails.
struct OnAFullDisk {
  ReportEvent event;
  ReportState from;
  bool taken;
};
void PrintTo(const OnAFullDisk& one, std::ostream* out) {
  *out << name_of(one.from) << ", event " << static_cast<int>(one.event);
}

const OnAFullDisk kFullDisk[] = {
    {ReportEvent::Chosen, Queued, false},     {ReportEvent::Held, Queued, false},
    {ReportEvent::Joined, Queued, false},     {ReportEvent::Withdrawn, Queued, false},
    {ReportEvent::Recorded, Sending, true},   {ReportEvent::Rejected, Sending, true},
    {ReportEvent::Throttled, Sending, true},  {ReportEvent::Barred, Sending, true},
    {ReportEvent::Redirected, Sending, true}, {ReportEvent::NeverLeft, Sending, true},
    {ReportEvent::Lost, Sending, true},       {ReportEvent::Restarted, Sending, true},
    {ReportEvent::Found, InDoubt, false},     {ReportEvent::Missing, InDoubt, false},
    {ReportEvent::Held, InDoubt, false},      {ReportEvent::Settled, InDoubt, false},
    {ReportEvent::Released, InDoubt, false},  {ReportEvent::Released, Held, false},
    {ReportEvent::Released, Rejected, false}, {ReportEvent::Released, Withdrawn, false},
};

class ReportBookOnAFullDisk : public testing::TestWithParam<OnAFullDisk> {};

TEST_P(ReportBookOnAFullDisk, AcceptsOnlyStepsThatHaveHappened) {
  FakeOutput output;
  ReportBook book(output);
  Report report;
  report.number = 1;
  report.state = GetParam().from;
  book.open({report});
  output.full = true;
  EXPECT_EQ(book.move({1, GetParam().event}, {}), GetParam().taken);
  const ReportState to = transition(GetParam().from, GetParam().event)->to;
  EXPECT_EQ(book.at(1).state, GetParam().taken ? to : GetParam().from);
  EXPECT_EQ(book.catch_up(), !GetParam().taken);

  output.full = false;
  EXPECT_TRUE(book.catch_up());
  EXPECT_EQ(output.ledger.contains(1), GetParam().taken) << "written later";
  const auto writes = output.writes;
  EXPECT_TRUE(book.catch_up());
  EXPECT_EQ(output.writes, writes) << "once";
}
INSTANTIATE_TEST_SUITE_P(Steps, ReportBookOnAFullDisk, testing::ValuesIn(kFullDisk));

TEST_F(ReportBookTest, WritesAMissedStepWithTheNextOne) {
  add({ReportEvent::Chosen});
  add();
  output_.full = true;
  EXPECT_TRUE(book_.move({1, ReportEvent::Recorded}, {}));
  EXPECT_FALSE(book_.move({2, ReportEvent::Chosen}, {}));
  output_.full = false;
  EXPECT_TRUE(book_.move({2, ReportEvent::Chosen}, {}));
  EXPECT_EQ(output_.ledger.at(1).state, Answered);
  EXPECT_EQ(output_.writes, 3) << "one write for both";
}

TEST_F(ReportBookTest, WritesANewRunLaterIfTheDiskIsFull) {
  output_.full = true;
  book_.write(dispatch::Run{.number = 2});
  EXPECT_EQ(output_.run, std::nullopt);
  output_.full = false;
  EXPECT_TRUE(book_.catch_up());
  EXPECT_EQ(output_.run->number, 2);
}

TEST_F(ReportBookTest, MovesSeveralReportsInOneWriteOrNone) {
  std::vector<Report> all(2);
  all[0] = {.number = 1, .state = InDoubt};
  all[1] = {.number = 2, .state = InDoubt};
  book_.open(all);
  const std::array steps = {ReportBook::Step{1, ReportEvent::Found}, ReportBook::Step{2, ReportEvent::Found}};
  output_.full = true;
  EXPECT_FALSE(book_.move(steps, {}));
  EXPECT_THAT(book_.doubts(0), testing::SizeIs(2));
  output_.full = false;
  EXPECT_TRUE(book_.move(steps, {}));
  EXPECT_EQ(output_.writes, 1);
  EXPECT_THAT(book_.doubts(0), IsEmpty());
}

TEST_F(ReportBookTest, StoresSeveralNotesInOneWriteOrNone) {
  add();
  add();
  std::vector<Report> noted = {book_.at(1), book_.at(2)};
  noted[0].note = noted[1].note = "why";
  output_.full = true;
  EXPECT_FALSE(book_.note(noted));
  EXPECT_EQ(book_.at(1).note, "");
  output_.full = false;
  EXPECT_TRUE(book_.note(noted));
  EXPECT_EQ(output_.writes, 3);
  EXPECT_EQ(output_.ledger.at(2).note, "why");
}

TEST_F(ReportBookTest, DelaysTheFlushOfARecoverableAnswer) {
  for (const bool known : {true, false}) {
    std::vector<Report> all(1);
    all[0] = {.number = 1, .state = Sending};
    if (known) all[0].before = icd::RunStatus{};
    book_.open(all);
    EXPECT_TRUE(book_.move({1, ReportEvent::Recorded}, {}));
    EXPECT_EQ(output_.last_flush, known ? Flush::Soon : Flush::Now);
  }
  add({ReportEvent::Chosen});
  EXPECT_EQ(output_.last_flush, Flush::Now);
  EXPECT_TRUE(book_.move({2, ReportEvent::Lost}, {}));
  EXPECT_EQ(output_.last_flush, Flush::Now);
}

TEST_F(ReportBookTest, ListsQueuedReportsAndDoubtsInOrderOfSending) {
  std::vector<Report> all(4);
  all[0] = {.number = 1, .state = InDoubt, .run = 2, .sending = 9};
  all[1] = {.number = 2, .state = InDoubt, .run = 2, .sending = 8};
  all[2] = {.number = 3, .state = InDoubt, .run = 1, .sending = 7};
  all[3] = {.number = 4};
  book_.open(all);
  EXPECT_THAT(book_.waiting(), ElementsAre(4));
  EXPECT_THAT(book_.doubts(2), ElementsAre(&book_.at(2), &book_.at(1)));
  EXPECT_THAT(book_.doubts(1), ElementsAre(&book_.at(3)));
  EXPECT_TRUE(book_.move({2, ReportEvent::Missing}, {}));
  EXPECT_THAT(book_.waiting(), ElementsAre(2, 4));
  EXPECT_EQ(book_.find(5), nullptr);
}

}  // namespace
}  // namespace adit::dispatch
