#include <gtest/gtest.h>

#include "forward/fixtures.hpp"
#include "forward/uri_pace.hpp"

namespace adit::forward {
namespace {

using namespace std::chrono_literals;

class ScoringPaceTest : public testing::Test, protected FlowParts {
 protected:
  static pace::Instant at(double seconds) {
    return pace::Instant{} +
           std::chrono::duration_cast<pace::Duration>(std::chrono::duration<double>(1000 + seconds));
  }
  static uplink::SendTimes left(double seconds) { return {.first = at(seconds), .last = at(seconds)}; }
  void ask_status(double seconds) {
    pace_.on_status_sent(at(seconds));
    pace_.on_status_accepted(left(seconds), at(seconds));
  }
  void refuse_report(double seconds, std::optional<std::chrono::seconds> retry_after = {}) {
    pace_.on_report_sent(at(seconds));
    pace_.on_report_throttled(left(seconds), retry_after, at(seconds));
  }

  void SetUp() override { journal_.begin({.boot = "b", .at = loop_.now(), .stamp = loop_.stamp_now()}); }

  ScoringPace pace_{settings_.command_post.rates, random_, journal_};
};

TEST_F(ScoringPaceTest, DelaysAStatusAfterAReport) {
  ask_status(0);
  EXPECT_LE(pace_.report_ready(), at(0));
  pace_.on_report_sent(at(0.5));
  pace_.on_report_accepted(left(0.5), at(0.6));
  EXPECT_GE(pace_.status_ready(false), at(1.5));
  EXPECT_LT(pace_.status_ready(true), at(1.1)) << "a status that decides a doubt";
}

TEST_F(ScoringPaceTest, OneLimitForBothIsDetected) {
  ask_status(0);
  refuse_report(0.1);
  EXPECT_TRUE(pace_.has_one_limit());
  EXPECT_GE(pace_.report_ready(), at(1.1));
  EXPECT_LT(pace_.report_ready(), at(1.2));
  ask_status(1.2);
  EXPECT_GE(pace_.report_ready(), at(2.2));
  EXPECT_GE(pace_.status_ready(true), at(2.2));
  pace_.on_new_command_post();
  EXPECT_FALSE(pace_.has_one_limit());
  EXPECT_GE(pace_.status_ready(true), at(2.2)) << "after the last status";
}

TEST_F(ScoringPaceTest, TheFirst429OfOneLimitTeachesNoSlowerPace) {
  const pace::Duration allowed = pace_.spacing();
  for (const double begin : {0.0, 10.0, 20.0, 30.0, 40.0}) {
    ask_status(begin);
    refuse_report(begin + 0.1);
    pace_.on_report_sent(at(begin + 1.2));
    pace_.on_report_accepted(left(begin + 1.2), at(begin + 1.2));
    EXPECT_EQ(pace_.spacing(), allowed) << begin;
    pace_.on_new_command_post();
  }
}

TEST_F(ScoringPaceTest, TheFirst429OfOneLimitMayAskForAPause) {
  ask_status(0);
  refuse_report(0.1, 7s);
  EXPECT_GE(pace_.report_ready(), at(7.1));
}

TEST_F(ScoringPaceTest, APauseHoldsForBothAndForTheNextEndpoint) {
  pace_.on_report_sent(at(0));
  pace_.on_report_accepted(left(0), at(0.1));
  pace_.on_status_sent(at(0.5));  // a status that decides a doubt
  pace_.on_status_throttled(left(0.5), 7s, at(0.6));
  EXPECT_TRUE(pace_.has_one_limit());
  EXPECT_GE(pace_.report_ready(), at(7.6));
  EXPECT_GE(pace_.status_ready(true), at(7.6));
  pace_.on_new_command_post();
  EXPECT_GE(pace_.status_ready(true), at(7.6));
}

TEST_F(ScoringPaceTest, AStormOfBothKindsIsNotOneLimit) {
  pace_.on_status_sent(at(0));
  pace_.on_status_throttled(left(0), {}, at(0.1));
  refuse_report(0.2);
  EXPECT_FALSE(pace_.has_one_limit());
}

TEST_F(ScoringPaceTest, ALate429IsAStorm) {
  ask_status(0);
  refuse_report(3);
  EXPECT_FALSE(pace_.has_one_limit());
  EXPECT_GE(pace_.report_ready(), at(4));
}

}  // namespace
}  // namespace adit::forward
