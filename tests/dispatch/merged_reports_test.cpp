// A spare takes over the reports of the first box.
#include "dispatch/merged_reports.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;
using testing::IsEmpty;

Books books_of(Scene& scene) {
  Books books;
  for (const auto& [number, report] : scene.output().ledger) books.reports.push_back(report);
  for (const auto& [number, run] : scene.output().runs) books.runs.push_back(run);
  return books;
}

/// As of a new box.
void blank(Scene& scene) {
  scene.output().ledger.clear();
  scene.output().runs.clear();
  scene.restart();
}

void restart_with(Scene& scene, const TakeoverChanges& taken) {
  for (const TakenOverReport& each : taken.reports) scene.output().ledger[each.report.number] = each.report;
  for (const Run& run : taken.runs) scene.output().runs[run.number] = run;
  scene.restart();
}

/// A box in use, and its spare.
class TakeOverTest : public testing::Test {
 protected:
  TakeOverTest() { blank(spare); }

  static void take_over(Scene& from, Scene& to, const std::optional<icd::RunStatus>& expected) {
    const TakeoverChanges taken = dispatch::take_over(
        books_of(to), books_of(from), {.expected = expected, .stamp = to.time().stamp, .ahead = 0});
    for (const TakenOverReport& each : taken.reports) {
      const auto here = to.output().ledger.find(each.report.number);
      const double received = here == to.output().ledger.end() ? each.report.received : here->second.received;
      EXPECT_EQ(received, each.report.received) << "no number is reused";
    }
    restart_with(to, taken);
  }
  void take_over() { take_over(first, spare, first.reports().expected_status(first.time().now)); }

  Scene first, spare;
};

TEST_F(TakeOverTest, KeepsAnswersOfTheFirstBox) {
  first.post(1);
  first.answer(recorded_answer(1));
  take_over();
  spare.receive_status(19, 1);
  const ClientId again = spare.post(1);
  EXPECT_EQ(spare.answer_to(again).status, 201);
  EXPECT_EQ(spare.answer_to(again).body, first.report(1).answer);
  EXPECT_EQ(spare.count(), 1U);
}

TEST_F(TakeOverTest, HoldsAReportThatTheFirstBoxCorrected) {
  spare.wait(1);
  spare.post_queued(1);
  first.post_queued(1);
  ASSERT_TRUE(first.reports().hold(1, first.time()));
  ASSERT_TRUE(first.reports().correct(1, {.type = "Drill", .position = {5, 0, 0}}, first.time()));
  ASSERT_EQ(first.send_next(), 2);
  first.answer(recorded_answer(1));
  take_over();
  spare.receive_status(19, 1);
  EXPECT_EQ(spare.state(1), Held);
  EXPECT_EQ(spare.send_next(), 0);
  EXPECT_EQ(spare.report(2).same_as, 3) << "numbers of this box";
}

TEST_F(TakeOverTest, SendsQueuedReportsThatTheStatusLacks) {
  first.post_queued(1);
  take_over();
  EXPECT_EQ(spare.state(1), InDoubt);
  EXPECT_THAT(spare.report(1).note, HasSubstr("may have sent it since"));
  spare.repeat_status(5, 20, 0);
  EXPECT_EQ(spare.send_next(), 0);
  spare.repeat_status(7, 20, 0);
  EXPECT_EQ(spare.send_next(), 1);
}

TEST_F(TakeOverTest, DetectsAReportSentAfterTheExport) {
  first.post_queued(1);
  take_over();
  spare.repeat_status(3, 19, 1);
  EXPECT_EQ(spare.state(1), Settled);
}

TEST_F(TakeOverTest, AsksTheOperatorIfSomeReportsWereSent) {
  first.post_queued(1);
  first.post_queued(2);
  take_over();
  spare.repeat_status(60, 19, 1);
  EXPECT_EQ(spare.send_next(), 0);
  EXPECT_EQ(spare.undecided().size(), 2U);
}

TEST_F(TakeOverTest, AsksTheOperatorIfTheCountIsUncertain) {
  first.post_queued(1);
  take_over(first, spare, std::nullopt);
  spare.repeat_status(60, 20, 0);
  EXPECT_EQ(spare.send_next(), 0);
  EXPECT_THAT(spare.undecided(), testing::ElementsAre(HasSubstr("the operator decides")));
}

TEST_F(TakeOverTest, DecidesAReportThatWasInFlight) {
  for (const bool was_recorded : {true, false}) {
    Scene box, other;
    blank(other);
    box.post(1);
    take_over(box, other, std::nullopt);
    EXPECT_EQ(other.state(1), InDoubt);
    EXPECT_EQ(other.report(1).tries, 1);
    other.repeat_status(12, was_recorded ? 19 : 20, 0);
    EXPECT_EQ(other.state(1), was_recorded ? Settled : Queued);
  }
}

TEST_F(TakeOverTest, KeepsTheOperatorsDecisions) {
  first.post_queued(1);
  ASSERT_TRUE(first.reports().hold(1, first.time()));
  first.post_queued(2);
  ASSERT_TRUE(first.reports().withdraw(2, first.time()));
  take_over();
  spare.repeat_status(30, 20, 0);
  EXPECT_EQ(spare.state(1), Held);
  EXPECT_EQ(spare.state(2), Withdrawn);
}

TEST_F(TakeOverTest, KeepsTheNumbersIfTheSpareIsBlank) {
  first.post(1);
  first.answer(recorded_answer());
  first.post(2);
  take_over();
  EXPECT_EQ(spare.report(1).report.position.x, 1);
  EXPECT_EQ(spare.report(2).report.position.x, 2);
  EXPECT_EQ(spare.reports().run().number, first.reports().run().number);
}

TEST_F(TakeOverTest, ChangesNothingTheSecondTime) {
  first.post(1);
  first.answer(recorded_answer());
  first.post_queued(2);
  Scene other;
  other.post_queued(3);
  take_over(first, other, first.reports().expected_status(first.time().now));
  const auto reports = other.output().ledger;
  const auto runs = other.output().runs;
  take_over(first, other, first.reports().expected_status(first.time().now));
  EXPECT_EQ(other.output().ledger, reports);
  EXPECT_EQ(other.output().runs, runs);
}

TEST_F(TakeOverTest, SendsReportsQueuedAtTheSpare) {
  Scene other;
  other.post_queued(7);
  first.post(1);
  first.answer(recorded_answer());
  take_over(first, other, first.reports().expected_status(first.time().now));
  other.receive_status(19, 0);
  EXPECT_EQ(other.send_next(), 1);
  EXPECT_EQ(other.report(2).report.position.x, 1) << "a free number";
}

TEST_F(TakeOverTest, AsksTheOperatorAboutAReportOfBothBoxes) {
  for (const bool first_sent : {true, false}) {
    Scene box, other;
    box.post_queued(1);
    other.wait(0.25);
    other.post_queued(1);
    Scene& sends = first_sent ? box : other;
    ASSERT_EQ(sends.send_next(), 1);
    sends.answer(recorded_answer());
    take_over(box, other, box.reports().expected_status(box.time().now));
    other.repeat_status(60, 19, 0);
    EXPECT_EQ(other.send_next(), 0);
    EXPECT_THAT(other.undecided(), testing::ElementsAre(HasSubstr("the same as report")));
  }
}

TEST_F(TakeOverTest, SendsAReportThatADifferentRunHad) {
  Scene other;
  other.post(1);
  other.answer(recorded_answer(0, "scored", "yesterday"));
  first.post(2);
  first.answer(recorded_answer(0, "scored", "today"));
  take_over(first, other, first.reports().expected_status(first.time().now));
  other.receive_status(19, 0);
  const ClientId again = other.post(1);
  EXPECT_FALSE(other.is_answered(again)) << "sent in today's run";
  EXPECT_NE(other.reports().sending(), nullptr);
}

TEST_F(TakeOverTest, WorksInTheOtherDirectionLater) {
  first.wait(1);
  first.post(1);
  first.answer(recorded_answer());
  first.post_queued(2);
  take_over();
  spare.wait(5);
  spare.repeat_status(12, 19, 0);
  ASSERT_EQ(spare.send_next(), 2);
  spare.answer(recorded_answer());
  spare.receive_status(18, 0);
  spare.post(3);
  spare.answer(recorded_answer());
  first.wait(60);
  take_over(spare, first, spare.reports().expected_status(spare.time().now));
  EXPECT_EQ(first.state(1), Answered);
  EXPECT_EQ(first.state(2), Answered) << "the spare sent it";
  EXPECT_EQ(first.state(3), Answered);
  first.receive_status(17, 0);
  EXPECT_EQ(first.answer_to(first.post(2)).status, 201);
  EXPECT_EQ(first.count(), 3U);
}

TEST_F(TakeOverTest, ToleratesAClockOffset) {
  first.repeat_status(40, 20, 0);
  first.post(1);
  first.answer(recorded_answer());
  spare.set_box_clock_forward(7200);
  const TakeoverChanges taken = dispatch::take_over(books_of(spare), books_of(first),
                                                    {.stamp = spare.time().stamp, .ahead = 7200 - 40});
  restart_with(spare, taken);
  spare.receive_status(19, 0, 145);
  EXPECT_EQ(spare.answer_to(spare.post(1)).status, 201);
}

TEST_F(TakeOverTest, IgnoresAnOlderExport) {
  first.post_queued(1);
  const Books before = books_of(first);
  take_over();
  spare.repeat_status(12, 20, 0);
  ASSERT_EQ(spare.send_next(), 1);
  spare.answer(recorded_answer());
  const TakeoverChanges taken = dispatch::take_over(books_of(spare), before, {.stamp = spare.time().stamp});
  EXPECT_THAT(taken.reports, IsEmpty());
}

/// A Command Post that counts, and both boxes.
class World {
 public:
  explicit World(unsigned seed) : random_(seed) { blank(spare_); }

  void live() {
    for (int i = 0; i < 4; ++i) post_one();
    const auto expected = first_.reports().expected_status(first_.time().now);
    if (chance(3)) wake_first_box();
    Books here, there = books_of(first_);
    const TakeoverChanges taken = dispatch::take_over(
        here, there, {.expected = chance(2) ? expected : std::nullopt, .stamp = spare_.time().stamp});
    restart_with(spare_, taken);
    for (int second = 0; second < 90; ++second) live_at_spare();
  }

  /// By x.
  const std::map<double, int>& recorded_times() const { return recorded_; }
  Scene& spare() { return spare_; }

 private:
  bool chance(unsigned of) { return random_() % of == 0; }
  void record(const Report& report) { ++recorded_[report.report.position.x]; }
  std::int64_t left() const {
    std::int64_t left = 20;
    for (const auto& [x, times] : recorded_) left -= times;
    return left;
  }

  void post_one() {
    const double x = ++posted_;
    if (first_.reports().sending() != nullptr || chance(3)) {
      first_.post_queued(x);
      waiting_.push_back(x);
      return;
    }
    first_.post(x);
    const Report* const sending = first_.reports().sending();
    if (sending == nullptr) return waiting_.push_back(x);
    const bool arrives = !chance(3);
    if (arrives) record(*sending);
    if (chance(2)) return;  // still in flight
    if (arrives && chance(2)) return first_.answer(recorded_answer(0));
    first_.lose_answer();
  }

  /// The first box was started again and sent some queued reports.
  void wake_first_box() {
    for (const double x : waiting_) {
      if (chance(2)) ++recorded_[x];
    }
  }

  void live_at_spare() {
    spare_.wait(1);
    if (spare_.reports().sending() == nullptr) spare_.receive_status(left(), 0);
    if (spare_.send_next() == 0) return;
    record(*spare_.reports().sending());
    spare_.answer(recorded_answer(0));
  }

  std::mt19937 random_;
  Scene first_, spare_;
  std::map<double, int> recorded_;
  std::vector<double> waiting_;
  double posted_ = 0;
};

TEST(TakeOverSimulation, RecordsEachReportOnceAndLosesNone) {
  std::size_t decided = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    World world(seed);
    world.live();
    for (const auto& [x, times] : world.recorded_times())
      ASSERT_LE(times, 1) << "x " << x << ", seed " << seed;
    for (const auto& [number, report] : world.spare().reports().book().all()) {
      const auto found = world.recorded_times().find(report.report.position.x);
      const bool was_recorded = found != world.recorded_times().end() && found->second > 0;
      if (!is_final(report.state)) continue;  // open for the operator
      ++decided;
      ASSERT_TRUE(was_recorded) << "report " << number << " is " << name_of(report.state) << ", seed "
                                << seed;
    }
    ASSERT_EQ(world.spare().count(), 4U) << "seed " << seed;
  }
  EXPECT_GT(decided, 200U) << "many need no operator";
}

}  // namespace
}  // namespace adit::dispatch
