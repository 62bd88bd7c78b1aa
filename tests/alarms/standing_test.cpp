#include "alarms/standing.hpp"

#include <gtest/gtest.h>

#include "alarms/alike.hpp"

namespace adit::alarms {
namespace {

/// uav1's grid, with everything else well.
class StandingTest : public testing::Test {
 protected:
  Standing standing() const { return standing_of(facts_.streams.front(), facts_); }
  void expect(Arrival arrival, Level level) const {
    EXPECT_EQ(standing().arrival, arrival);
    EXPECT_EQ(standing().level, level);
  }

  Facts facts_ = well(1);
  Stream& stream_ = facts_.streams.front();
  Robot& robot_ = facts_.robots.begin()->second;
  PostTrouble& mapping_ = facts_.endpoints[1].trouble;
};

TEST_F(StandingTest, IsThatOfTheStreamWhereNothingLargerIsWrong) {
  expect(Arrival::UpToDate, Level::Good);
  robot_.silent = true;
  expect(Arrival::Silent, Level::Bad);
}

TEST_F(StandingTest, BlamesNoRobotWhileTheMappingEndpointTakesNothing) {
  for (const PostTrouble trouble : {PostTrouble::NoToken, PostTrouble::Unreachable, PostTrouble::Foreign,
                                    PostTrouble::Refusing, PostTrouble::Silent, PostTrouble::Failing}) {
    mapping_ = trouble;
    stream_ = {.kind = "grid", .robot = stream_.robot, .behind = 200, .forwarded = 200};
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = {.kind = "grid", .robot = stream_.robot, .behind = 3, .forwarded = 9, .failed = true};
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = {.kind = "grid", .robot = stream_.robot, .forwarded = 9, .last_status = 401};
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = {.kind = "grid", .robot = stream_.robot, .behind = 3, .forwarded = 9, .last_status = 200};
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = {.kind = "grid", .robot = stream_.robot, .forwarded = 3, .last_status = 200};
    robot_.silent = true;
    expect(Arrival::UpToDate, Level::Good);
  }
}

TEST_F(StandingTest, BlamesNoRobotForWhatTheEndpointDidNotTakeUntilItsTurnHasCome) {
  facts_.turn = 20;
  facts_.endpoints[1].well_for = 29;
  stream_ = {.kind = "grid", .robot = stream_.robot, .behind = 200, .forwarded = 200, .failed = true};
  expect(Arrival::Late, Level::Wait);
  stream_ = {.kind = "grid", .robot = stream_.robot, .behind = 60, .forwarded = 60, .last_status = 401};
  expect(Arrival::Late, Level::Wait);
  stream_.last_status = 422;
  expect(Arrival::Refused, Level::Bad);
  stream_ = {.kind = "grid", .robot = stream_.robot, .forwarded = 1, .last_status = 200};
  expect(Arrival::UpToDate, Level::Good);
  robot_.silent = true;
  expect(Arrival::Silent, Level::Bad);
  robot_.silent = false;
  facts_.endpoints[1].well_for = 31;
  stream_ = {.kind = "grid", .robot = stream_.robot, .behind = 200, .forwarded = 200, .failed = true};
  expect(Arrival::NotArriving, Level::Bad);
}

TEST_F(StandingTest, IsItsOwnWhileItIsOnlyScoringThatDoesNotAnswerOrMappingThatThrottles) {
  stream_.behind = 200;
  facts_.endpoints[0].trouble = PostTrouble::Unreachable;
  expect(Arrival::NotArriving, Level::Bad);
  mapping_ = PostTrouble::Throttling;
  expect(Arrival::NotArriving, Level::Bad);
}

TEST_F(StandingTest, BlamesNoRobotForTheTeamsCable) {
  robot_.silent = true;
  facts_.cables = {{.is_team = true, .interface = "team0", .carrier = false}};
  expect(Arrival::UpToDate, Level::Good);
  facts_.cables.front().carrier = true;
  expect(Arrival::Silent, Level::Bad);
}

}  // namespace
}  // namespace adit::alarms
