#include "dispatch/run_account.hpp"

#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// At `now_` seconds of a run.
class RunAccountTest : public testing::Test {
 protected:
  Time at(double s) const {
    return {Instant{} + std::chrono::milliseconds(static_cast<std::int64_t>(s * 1000)), Scene::kEpoch + s};
  }
  Time time() const { return at(now_); }
  icd::RunStatus status(std::int64_t remaining, std::int64_t score) const {
    return {score, now_, remaining, "adit"};
  }
  void receive_status(std::int64_t remaining, std::int64_t score) {
    account_.on_status(status(remaining, score), time());
    account_.settle(status(remaining, score), 0, time());
  }
  void answer(const std::string& report_status, std::int64_t points) {
    icd::ReportReply reply;
    reply.run = "1";
    reply.report_status = report_status;
    reply.score_change = points;
    account_.on_answered(reply, time());
  }

  FakeOutput output_;
  ReportBook book_{output_};
  RunAccount account_{book_};
  double now_ = 100;
};

TEST_F(RunAccountTest, ExpectsNothingBeforeTheFirstStatus) {
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt);
  EXPECT_FALSE(account_.is_fresh(time().now));
}

TEST_F(RunAccountTest, AStatusVouchesUntilTheNextMayBeSent) {
  receive_status(20, 3);
  EXPECT_TRUE(account_.is_fresh(at(now_ + 15).now));
  EXPECT_FALSE(account_.is_fresh(at(now_ + 16).now));
  account_.set_spacing(std::chrono::seconds(20));
  EXPECT_TRUE(account_.is_fresh(at(now_ + 22).now)) << "a report would never be sent";
  EXPECT_FALSE(account_.is_fresh(at(now_ + 27).now));
}

TEST_F(RunAccountTest, ExpectsTheLastStatusAndItsOwnReports) {
  receive_status(20, 3);
  answer("scored", 1);
  answer("scored", 0);
  now_ += 7;
  EXPECT_EQ(account_.expected_status(time().now), status(18, 4));
}

TEST_F(RunAccountTest, ExpectsNothingDuringADoubt) {
  receive_status(20, 3);
  account_.forget_expected();
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt);
  receive_status(19, 3);
  EXPECT_EQ(account_.expected_status(time().now), status(19, 3));
}

TEST_F(RunAccountTest, ExpectsNothingSoonAfterASettlement) {
  receive_status(20, 3);
  account_.forget_expected(at(110).now);
  receive_status(20, 3);
  now_ = 109;
  receive_status(19, 3);
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt);
  now_ = 110;
  receive_status(19, 3);
  EXPECT_EQ(account_.expected_status(time().now), status(19, 3));
  EXPECT_THAT(account_.run().unreliable, IsEmpty());
}

TEST_F(RunAccountTest, ExpectsNothingWhileReportsAreNotScored) {
  receive_status(20, 3);
  answer("admin stop", 0);
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt);
  answer("scored", 0);
  EXPECT_EQ(account_.expected_status(time().now), status(19, 3));
}

TEST_F(RunAccountTest, DistrustsACountIfItIsWrongTwice) {
  receive_status(20, 3);
  receive_status(19, 3);
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt) << "wrong once";
  EXPECT_THAT(account_.run().unreliable, IsEmpty());
  receive_status(19, 3);
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt);
  EXPECT_THAT(account_.run().unreliable, HasSubstr("another sender may report with this token"));
  EXPECT_EQ(output_.run->unreliable, account_.run().unreliable) << "on disk";
}

TEST_F(RunAccountTest, AccusesNoSenderIfTheCountsNeverMove) {
  receive_status(20, 3);
  answer("scored", 1);
  receive_status(20, 3);
  receive_status(20, 3);
  EXPECT_EQ(account_.run().unreliable, Run::kCountsStand);
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt);
}

TEST_F(RunAccountTest, DistrustsCountsThatStopMoving) {
  receive_status(20, 3);
  answer("scored", 0);
  receive_status(19, 3);
  answer("scored", 0);
  receive_status(19, 3);
  receive_status(19, 3);
  EXPECT_THAT(account_.run().unreliable, HasSubstr("the counts may have been corrected"));
}

TEST_F(RunAccountTest, ForgivesADelayedCount) {
  receive_status(20, 3);
  answer("scored", 0);
  receive_status(20, 3);
  receive_status(19, 3);
  EXPECT_EQ(account_.expected_status(time().now), status(19, 3));
  EXPECT_THAT(account_.run().unreliable, IsEmpty());
}

TEST_F(RunAccountTest, ExpectsTheCountWithGrantedReports) {
  receive_status(20, 3);
  now_ = 110;
  account_.grant();
  receive_status(23, 3);
  EXPECT_EQ(account_.expected_status(time().now), status(23, 3));
  EXPECT_THAT(account_.run().unreliable, IsEmpty());
}

TEST_F(RunAccountTest, ExpectsNothingAfterAGrantUntilItsOwnReportsMustBeCounted) {
  receive_status(20, 3);
  answer("scored", 0);
  now_ = 110;
  account_.grant();
  receive_status(21, 3);
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt) << "the report may be counted later";
  now_ = 111;
  receive_status(21, 3);
  EXPECT_EQ(account_.expected_status(time().now), status(21, 3));
}

TEST_F(RunAccountTest, AllowsNewCountsBeforeTheRunStarts) {
  now_ = 0;
  receive_status(5, 0);
  now_ = 10;
  receive_status(25, 0);
  EXPECT_EQ(account_.expected_status(time().now), status(25, 0));
}

TEST_F(RunAccountTest, TrustsTheCountInTheNextRun) {
  receive_status(20, 3);
  account_.distrust("another sender", time().stamp);
  account_.begin({"the operator declared it", {}}, 0, std::nullopt, {}, time());
  EXPECT_EQ(account_.run().number, 2);
  EXPECT_EQ(account_.expected_status(time().now), std::nullopt);
  receive_status(25, 0);
  EXPECT_EQ(account_.expected_status(time().now), status(25, 0));
}

TEST_F(RunAccountTest, IsFreshForFifteenSecondsAfterAnAnswer) {
  receive_status(20, 3);
  EXPECT_TRUE(account_.is_fresh(at(115).now));
  EXPECT_FALSE(account_.is_fresh(at(115.1).now));
  now_ = 114;
  answer("scored", 0);
  EXPECT_TRUE(account_.is_fresh(at(129).now));
}

TEST_F(RunAccountTest, DetectsACommandPostWithoutAStatus) {
  EXPECT_FALSE(account_.is_dumb(time().now));
  account_.on_dumb(time().now);
  EXPECT_TRUE(account_.is_dumb(time().now));
  EXPECT_FALSE(account_.is_dumb(at(116).now)) << "too old";
  receive_status(20, 3);
  EXPECT_FALSE(account_.is_dumb(time().now));
}

TEST_F(RunAccountTest, WritesTheRunClockSeldom) {
  receive_status(20, 3);
  now_ = 101;
  receive_status(20, 3);
  EXPECT_TRUE(output_.run->status_clock->runs);
  const auto writes = output_.writes;
  for (now_ = 102; now_ < 250; ++now_) receive_status(20, 3);
  EXPECT_EQ(output_.writes, writes);
  now_ = 252;
  receive_status(20, 3);
  EXPECT_EQ(output_.writes, writes + 1);
  EXPECT_EQ(output_.run->last->run_clock, 252);
}

TEST_F(RunAccountTest, WritesTheReportsLeftAtOnce) {
  receive_status(20, 3);
  now_ = 101;
  receive_status(19, 3);
  EXPECT_EQ(output_.run->last->remaining_reports, 19) << "it shows a new run";
}

TEST_F(RunAccountTest, MeasuresASilenceByMonotonicTime) {
  now_ = 99;
  receive_status(20, 3);
  now_ = 100;
  receive_status(20, 3);
  const Time set{at(105).now, at(105 + 3600).stamp};
  EXPECT_EQ(account_.another(icd::RunStatus{3, 105, 20, "adit"}, set), std::nullopt);
  EXPECT_THAT(account_.another(icd::RunStatus{3, 105, 20, "adit"}, at(3700))->why, HasSubstr("of silence"));
}

TEST_F(RunAccountTest, MeasuresASilenceAcrossARestart) {
  now_ = 99;
  receive_status(20, 3);
  now_ = 100;
  receive_status(20, 3);
  RunAccount again(book_);
  again.open({*output_.run}, 1, "");
  EXPECT_THAT(again.another(icd::RunStatus{3, 105, 20, "adit"}, at(3700))->why, HasSubstr("of silence"));
  EXPECT_EQ(again.another(icd::RunStatus{3, 120, 20, "adit"}, at(120)), std::nullopt);
}

TEST_F(RunAccountTest, ContinuesTheLatestRunOfAReport) {
  account_.open({dispatch::Run{.number = 2, .id = "two"}}, 3, "");
  EXPECT_EQ(account_.run().number, 3);
  EXPECT_THAT(account_.run().id, IsEmpty());
}

}  // namespace
}  // namespace adit::dispatch
