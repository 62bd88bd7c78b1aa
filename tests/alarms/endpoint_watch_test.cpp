#include <gtest/gtest.h>

#include "alarms/habits.hpp"

namespace adit::alarms {
namespace {

using enum EndpointFault;

/// One or two connections of an endpoint, checked each second.
class EndpointWatchTest : public testing::Test {
 protected:
  explicit EndpointWatchTest(std::size_t ways = 1) : seen_(ways) {
    for (ConnectionSample& each : seen_) each.connected = true;
    lasts(1);
  }
  void lasts(int seconds) {
    for (int i = 0; i < seconds; ++i) watch_.update(seen_, now_++);
  }
  /// One request per second gets that status.
  void answers(int status, int seconds, std::size_t way = 0) {
    ConnectionSample& seen = seen_.at(way);
    for (int i = 0; i < seconds; ++i) {
      ++seen.ended;
      if (status == 429) ++seen.throttled;
      seen.status = status;
      seen.said = status < 400 ? "" : "it answered " + std::to_string(status);
      seen.busy = false;
      lasts(1);
    }
  }
  EndpointFault fault() const { return watch_.endpoint(now_).fault; }

  EndpointWatch watch_;
  std::vector<ConnectionSample> seen_;
  double now_ = 1000;
};

TEST_F(EndpointWatchTest, AnsweringEndpointHasNoTrouble) {
  answers(200, 20);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, EndpointWithoutAnswersIsSilent) {
  answers(200, 3);
  seen_[0].busy = true;
  lasts(14);
  EXPECT_EQ(fault(), None);
  EXPECT_EQ(watch_.endpoint(now_).waits, 14);
  lasts(2);
  EXPECT_EQ(fault(), Silent);
  EXPECT_EQ(watch_.endpoint(now_).since, 1004);
  answers(200, 1);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, TellsHowLongTheEndpointHasRecovered) {
  answers(200, 3);
  EXPECT_EQ(watch_.endpoint(now_).well_for, 4) << "since the start: restored messages count from then on";
  answers(500, 8);
  EXPECT_EQ(watch_.endpoint(now_).well_for, std::nullopt);
  answers(200, 1);
  EXPECT_EQ(watch_.endpoint(now_).well_for, 1);
  answers(200, 5);
  EXPECT_EQ(watch_.endpoint(now_).well_for, 6);
  answers(500, 8);
  EXPECT_EQ(watch_.endpoint(now_).well_for, std::nullopt) << "the next problem";
  watch_.forget();
  lasts(3);
  EXPECT_EQ(watch_.endpoint(now_).well_for, 3) << "another course accepts the queued messages";
}

TEST_F(EndpointWatchTest, EndpointStaysSilentWhileRequestsTimeOut) {
  for (int i = 0; i < 4; ++i) {
    seen_[0].busy = true;
    seen_[0].sent += 300;
    lasts(9);
    EXPECT_EQ(fault(), i > 0 ? Silent : None) << "a retry is not an answer";
    seen_[0].busy = false;
    ++seen_[0].ended;
    seen_[0].status = 0;
    seen_[0].said = "no answer within 10000 ms";
    lasts(1);
  }
  EXPECT_EQ(fault(), Silent);
  answers(200, 1);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, EndpointIsNotSilentDuringAnUpload) {
  seen_[0].busy = true;
  for (int i = 0; i < 60; ++i) {
    seen_[0].sent += 10'000;
    lasts(1);
  }
  EXPECT_EQ(fault(), None) << "a large map on a slow link";
  lasts(17);
  EXPECT_EQ(fault(), Silent);
}

TEST_F(EndpointWatchTest, EndpointWithoutConnectionIsUnreachable) {
  seen_[0].connected = false;
  seen_[0].said = "connecting to 10.100.1.200:8000: Connection refused";
  lasts(2);
  EXPECT_EQ(fault(), None);
  lasts(2);
  EXPECT_EQ(fault(), Unreachable);
  EXPECT_EQ(watch_.endpoint(now_).said, seen_[0].said);
  seen_[0].connected = true;
  seen_[0].said = "";
  lasts(1);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, EndpointThatClosesAfterErrorsIsFailing) {
  for (int i = 0; i < 4; ++i) {
    answers(500, 1);
    seen_[0].connected = false;
    lasts(3);
  }
  EXPECT_EQ(fault(), Failing) << "each connection succeeds";
}

TEST_F(EndpointWatchTest, IdleConnectionIsNoTrouble) {
  seen_[0].connected = false;
  lasts(60);
  EXPECT_EQ(fault(), None) << "no message was queued";
}

TEST_F(EndpointWatchTest, DistinguishesRefusingAndForeignEndpoints) {
  answers(401, 1);
  EXPECT_EQ(fault(), Refusing);
  answers(403, 1);
  EXPECT_EQ(fault(), Refusing);
  seen_[0].foreign = true;
  answers(200, 1);
  EXPECT_EQ(fault(), Foreign);
  seen_[0].foreign = false;
  answers(200, 1);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, EndpointWithOnlyErrorAnswersIsFailing) {
  answers(500, 7);
  EXPECT_EQ(fault(), Failing);
  EXPECT_EQ(watch_.endpoint(now_).said, "it answered 500");
  answers(200, 1);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, EndpointThatRejectsMessagesIsNotFailing) {
  answers(422, 20);
  EXPECT_EQ(fault(), None) << "a rejected message is not the endpoint's fault";
}

TEST_F(EndpointWatchTest, SeveralThrottledAnswersAreTrouble) {
  answers(429, 2);
  EXPECT_EQ(fault(), None) << "an occasional 429 is part of learning the rate";
  answers(429, 1);
  EXPECT_EQ(fault(), Throttling);
  answers(200, 31);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, ForgetsTheFormerEndpoint) {
  answers(500, 20);
  watch_.forget();
  lasts(1);
  EXPECT_EQ(fault(), None);
}

TEST_F(EndpointWatchTest, OneRejectedRobotIsNoTroubleOfTheToken) {
  watch_ = EndpointWatch(true);
  lasts(1);
  answers(403, 1);
  EXPECT_EQ(fault(), Refusing) << "no message was accepted yet";
  for (int i = 0; i < 10; ++i) {
    answers(200, 1);
    answers(403, 4);
    EXPECT_EQ(fault(), None) << "others are accepted";
  }
  answers(401, 2);
  EXPECT_EQ(fault(), Refusing) << "no message is accepted any more";
}

class TwoConnections : public EndpointWatchTest {
 protected:
  TwoConnections() : EndpointWatchTest(2) {}
};

TEST_F(TwoConnections, OneFailingConnectionIsNoTroubleOfTheEndpoint) {
  for (int i = 0; i < 30; ++i) {
    answers(500, 1, 0);
    answers(200, 1, 1);
  }
  EXPECT_EQ(fault(), None) << "states are accepted";
  answers(500, 20, 0);
  EXPECT_EQ(fault(), Failing) << "no other message was accepted for long";
}

TEST_F(TwoConnections, BothFailingConnectionsAreTroubleOfTheEndpoint) {
  for (int i = 0; i < 5; ++i) {
    answers(500, 1, 0);
    answers(500, 1, 1);
  }
  EXPECT_EQ(fault(), Failing);
}

}  // namespace
}  // namespace adit::alarms
