#include "alarms/verdict.hpp"

#include <gtest/gtest.h>

#include "alarms/alike.hpp"

namespace adit::alarms {
namespace {

TEST(Verdict, TellsTheAgeOfArrivingMaps) {
  const Verdict verdict = verdict_of(well(20));
  EXPECT_EQ(verdict, (Verdict{Level::Good, "Every map arrives", "20 robots, oldest 22 s"}));
}

TEST(Verdict, IgnoresMapsThatAreNoLongerSent) {
  Facts facts = well(2);
  facts.streams.push_back({.kind = "cloud", .robot = "uav1", .forwarded = 600.0, .last_status = 200});
  EXPECT_EQ(verdict_of(facts).why, "2 robots, oldest 4 s");
  facts.streams.push_back({.kind = "cloud", .robot = "uav2", .forwarded = 9.0, .last_status = 200});
  EXPECT_EQ(verdict_of(facts).why, "2 robots, oldest 9 s") << "the oldest of each robot's maps";
}

TEST(Verdict, NamesASilentRobot) {
  Facts facts = well(20);
  facts.robots["uav5"].silent = true;
  EXPECT_EQ(verdict_of(facts), (Verdict{Level::Wait, "19 of 20 arrive", "not uav5; oldest other 22 s"}));
}

TEST(Verdict, NamesARobotSilentSinceARestart) {
  Facts facts = well(3);
  facts.robots["uav9"] = {.quiet = 40, .silent = true};
  EXPECT_EQ(verdict_of(facts), (Verdict{Level::Wait, "3 of 4 arrive", "not uav9; oldest other 5 s"}));
  facts.streams.push_back({.kind = "state", .robot = "uav9", .forwarded = 50.0, .last_status = 200});
  EXPECT_EQ(verdict_of(facts).what, "Every map arrives") << "the robot sends no maps";
}

TEST(Verdict, NamesAtMostThreeRobots) {
  Facts facts = well(6);
  for (auto& [name, robot] : facts.robots) robot.silent = name != "uav6";
  EXPECT_EQ(verdict_of(facts),
            (Verdict{Level::Wait, "1 of 6 arrive", "not uav1, uav2, uav3 and 2 more; the other 8 s"}));
  facts.robots["uav6"].silent = true;
  EXPECT_EQ(verdict_of(facts).what, "No map arrives");
  EXPECT_EQ(verdict_of(facts).level, Level::Bad);
}

TEST(Verdict, ShowsTheAgeThatDecidesItsLevel) {
  Facts facts = well(3);
  facts.streams[0].forwarded = 540;  // it paused, and its newest map is in flight
  facts.streams[0].behind = 2;
  EXPECT_EQ(verdict_of(facts), (Verdict{Level::Good, "Every map arrives", "3 robots, oldest 5 s"}));
}

TEST(Verdict, TellsThatMapsAreLate) {
  Facts facts = well(3);
  facts.streams[0].behind = 11;
  EXPECT_EQ(verdict_of(facts), (Verdict{Level::Wait, "Maps are late", "uav1"}));
}

TEST(Verdict, TellsThatNoMapArrivesDuringAnOutage) {
  Facts facts = well(20);
  facts.endpoints[1].trouble = EndpointTrouble::Silent;
  facts.endpoints[1].since = kNow - 72;
  EXPECT_EQ(verdict_of(facts), (Verdict{Level::Bad, "No map arrives", "for 1:12; the box keeps all maps"}));
  facts.endpoints[1].trouble = EndpointTrouble::Throttling;
  EXPECT_EQ(verdict_of(facts).level, Level::Good) << "the endpoint accepts the maps";
}

TEST(Verdict, HasNoDurationIfTheTokenIsMissing) {
  Facts facts = well(3);
  facts.endpoints[1].trouble = EndpointTrouble::NoToken;
  EXPECT_EQ(verdict_of(facts),
            (Verdict{Level::Bad, "No map arrives", "the mapping token is missing; the box keeps all maps"}));
}

TEST(Verdict, IsEmptyWithoutMaps) {
  EXPECT_EQ(verdict_of(well(0)),
            (Verdict{Level::Quiet, "No map yet", "no robot has sent one since the box started"}));
}

TEST(Verdict, TellsTheTimeSinceTheLastNewMap) {
  Facts facts = well(2);
  for (Stream& stream : facts.streams) stream.forwarded = *stream.forwarded + 600;
  EXPECT_EQ(verdict_of(facts), (Verdict{Level::Quiet, "Every map arrived", "no new map for 10 min"}));
}

TEST(Verdict, OmitsTheCountOfOneRobot) {
  EXPECT_EQ(verdict_of(well(1)), (Verdict{Level::Good, "Every map arrives", "1 robot, 3 s"}));
}

TEST(Verdict, DoesNotCountTheMergedMapAsARobot) {
  Facts facts = well(2);
  facts.streams.push_back({.kind = "grid", .robot = "", .forwarded = 9.0, .last_status = 200});
  EXPECT_EQ(verdict_of(facts).why, "2 robots and the merged map, oldest 9 s");
  facts.streams.erase(facts.streams.begin(), facts.streams.end() - 1);
  EXPECT_EQ(verdict_of(facts).why, "the merged map, 9 s");
}

/// uav1's grid, with all other streams good.
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
  EndpointTrouble& mapping_ = facts_.endpoints[1].trouble;
};

TEST_F(StandingTest, IsThatOfTheStreamWithoutOtherFaults) {
  expect(Arrival::UpToDate, Level::Good);
  robot_.silent = true;
  expect(Arrival::Silent, Level::Bad);
}

TEST_F(StandingTest, BlamesNoRobotWhileMappingIsDown) {
  for (const EndpointTrouble trouble :
       {EndpointTrouble::NoToken, EndpointTrouble::Unreachable, EndpointTrouble::Foreign,
        EndpointTrouble::Refusing, EndpointTrouble::Silent, EndpointTrouble::Failing}) {
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

TEST_F(StandingTest, BlamesNoRobotJustAfterAnOutage) {
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

TEST_F(StandingTest, BlamesTheRobotDuringScoringOutageOrThrottling) {
  stream_.behind = 200;
  facts_.endpoints[0].trouble = EndpointTrouble::Unreachable;
  expect(Arrival::NotArriving, Level::Bad);
  mapping_ = EndpointTrouble::Throttling;
  expect(Arrival::NotArriving, Level::Bad);
}

TEST_F(StandingTest, BlamesNoRobotForTheTeamCable) {
  robot_.silent = true;
  facts_.cables = {{.is_team = true, .interface = "team0", .carrier = false}};
  expect(Arrival::UpToDate, Level::Good);
  facts_.cables.front().carrier = true;
  expect(Arrival::Silent, Level::Bad);
}

}  // namespace
}  // namespace adit::alarms
