#include "alarms/verdict.hpp"

#include <gmock/gmock.h>

#include "alarms/alike.hpp"
#include "alarms/board.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

Verdict verdict_of(Snapshot snapshot) {
  add_words(snapshot.traffic, {});
  return alarms::verdict_of(snapshot.traffic);
}

/// well(), where the Command Post lacks a map of each robot.
Snapshot busy(std::size_t robots) {
  Snapshot snapshot = well(robots);
  double age = 1.05;
  for (ActivityRow& row : snapshot.traffic.activities) {
    if (row.is_map()) row.age = age += 0.4;
  }
  return snapshot;
}

void fall_silent(Snapshot& snapshot, const std::string& robot) {
  snapshot.traffic.habits[robot] = {.gap = 1, .quiet = 120, .silent = true};
  for (ActivityRow& row : snapshot.traffic.activities) {
    if (row.robot == robot) row.age = std::nullopt, row.heard = 120;
  }
}

ActivityRow merged(std::optional<double> age, double heard) {
  return {.kind = "grid", .last_forwarded = kNow, .age = age, .heard = heard, .last_status = 200};
}

TEST(Verdict, TellsTheAgeOfTheOldestUndeliveredMap) {
  EXPECT_EQ(verdict_of(busy(20)), (Verdict{Level::Good, "Every map arrives", "20 robots, oldest 9 s"}));
  EXPECT_EQ(verdict_of(well(20)), (Verdict{Level::Good, "Every map arrives", "20 robots, up to date"}));
}

TEST(Verdict, NamesQuietRobots) {
  Snapshot snapshot = busy(2);
  ActivityRow quiet{
      .kind = "cloud", .robot = "uav1", .last_forwarded = kNow, .heard = 600, .last_status = 200};
  snapshot.traffic.activities.push_back(quiet);
  EXPECT_EQ(verdict_of(snapshot).why, "2 robots, oldest 1 s") << "the robot's other map is not quiet";
  quiet.robot = "uav3";
  snapshot.traffic.activities.push_back(quiet);
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Good, "Every map arrives", "2 robots, oldest 1 s; uav3 quiet"}));
}

TEST(Verdict, NamesRobotsWithoutAMap) {
  Snapshot snapshot = busy(2);
  snapshot.traffic.activities.push_back(
      {.kind = "state", .robot = "uav9", .last_forwarded = kNow, .heard = 1});
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Good, "2 of 3 arrive", "oldest 1 s; no map from uav9"}));
  snapshot.traffic.activities[0].age = 11;
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "Maps are late", "uav1, 11 s behind; no map from uav9"}));
  fall_silent(snapshot, "uav1");
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "1 of 3 arrive", "uav1 silent; no map from uav9; the other 1 s"}));
}

TEST(Verdict, NamesRegisteredRobotsThatWereNeverHeard) {
  Snapshot snapshot = busy(2);
  snapshot.traffic.registered = {"uav1", "uav2"};
  EXPECT_EQ(verdict_of(snapshot).what, "Every map arrives");
  snapshot.traffic.registered = {"uav10", "uav1", "uav9"};
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Good, "2 of 4 arrive", "oldest 1 s; no map from uav9, uav10"}));
}

TEST(Verdict, IsAboutTheMergedMapIfNoRobotHasAnother) {
  Snapshot snapshot = well(0);
  snapshot.traffic.activities = {merged({}, 1)};
  snapshot.traffic.registered = {"uav1"};
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Good, "The merged map arrives", "up to date; no map from uav1"}));
  snapshot.traffic.activities = {merged({}, 600)};
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Quiet, "The merged map arrived", "no new map for 10 min; no map from uav1"}));
}

TEST(Verdict, CountsRobotsWithoutTheMergedMap) {
  Snapshot snapshot = busy(3);
  snapshot.traffic.activities.push_back(merged(1.0, 1));
  snapshot.traffic.registered = {"uav9"};
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Good, "3 of 4 arrive", "oldest 2 s; no map from uav9"}));
  snapshot.traffic.registered = {};
  snapshot.traffic.activities.back().last_status = 422;
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "The merged map does not arrive", "3 robots, oldest 2 s"}));
  snapshot.traffic.activities.back().last_status = 200;
  for (const char* name : {"uav1", "uav2", "uav3"}) fall_silent(snapshot, name);
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "Only the merged map arrives", "uav1, uav2, uav3 silent; the other 1 s"}));
}

TEST(Verdict, NamesASilentRobot) {
  Snapshot snapshot = busy(20);
  fall_silent(snapshot, "uav5");
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Wait, "19 of 20 arrive", "uav5 silent; oldest other 9 s"}));
}

TEST(Verdict, CountsNoQuietMapAsArriving) {
  Snapshot snapshot = busy(1);
  snapshot.traffic.activities.push_back(merged({}, 109));
  fall_silent(snapshot, "uav1");
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Bad, "No map arrives", "uav1 silent; the merged map quiet"}));
}

TEST(Verdict, NamesARobotSilentSinceARestart) {
  Snapshot snapshot = busy(3);
  snapshot.traffic.habits["uav9"] = {.quiet = 40, .silent = true};
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Wait, "3 of 4 arrive", "uav9 silent; oldest other 2 s"}));
  snapshot.traffic.activities.push_back(
      {.kind = "state", .robot = "uav9", .last_forwarded = kNow, .heard = 50});
  EXPECT_EQ(verdict_of(snapshot).what, "3 of 4 arrive") << "the robot sends no maps";
  EXPECT_EQ(verdict_of(snapshot).level, Level::Good);
}

TEST(Verdict, NamesRobotsByTheirNumbers) {
  Snapshot snapshot = busy(12);
  for (const char* name : {"uav10", "uav2"}) fall_silent(snapshot, name);
  EXPECT_EQ(verdict_of(snapshot).why, "uav2, uav10 silent; oldest other 5 s");
  add_words(snapshot.traffic, {});
  EXPECT_EQ(snapshot.traffic.standings[1].name, "uav2");
}

TEST(Verdict, NamesAtMostThreeRobots) {
  Snapshot snapshot = busy(6);
  for (const char* name : {"uav1", "uav2", "uav3", "uav4", "uav5"}) fall_silent(snapshot, name);
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "1 of 6 arrive", "uav1, uav2, uav3 and 2 more silent; the other 3 s"}));
  fall_silent(snapshot, "uav6");
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Bad, "No map arrives", "uav1, uav2, uav3 and 3 more silent"}));
}

TEST(Verdict, NamesFailingMapsApartFromSilentRobots) {
  Snapshot snapshot = busy(3);
  snapshot.traffic.activities[0].last_status = 422;
  fall_silent(snapshot, "uav2");
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "1 of 3 arrive", "not uav1; uav2 silent; the other 2 s"}));
}

TEST(Verdict, TellsThatMapsAreLate) {
  Snapshot snapshot = busy(3);
  snapshot.traffic.activities[0].age = 11;
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Wait, "Maps are late", "uav1, 11 s behind"}));
}

TEST(Verdict, CallsNoFirstMapLate) {
  Snapshot snapshot = busy(2);
  const ActivityRow first{.kind = "grid", .robot = "uav9", .age = 1, .heard = 1};
  snapshot.traffic.activities.push_back(first);
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Good, "2 of 3 arrive", "oldest 1 s; no map yet from uav9"}));
  snapshot.traffic.activities.back().robot = "uav1";
  EXPECT_EQ(verdict_of(snapshot).why, "2 robots, oldest 1 s") << "a second kind of map";
  snapshot.traffic.activities.back() = first;
  snapshot.traffic.activities[0].age = 11;
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "Maps are late", "uav1, 11 s behind; no map yet from uav9"}));
  fall_silent(snapshot, "uav1");
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Wait, "1 of 3 arrive", "uav1 silent; no map yet from uav9; the other 1 s"}));
  snapshot.traffic.activities.back().age = 11;
  EXPECT_EQ(verdict_of(snapshot).what, "2 of 3 arrive") << "a first map that is late";
  snapshot = well(0);
  snapshot.traffic.activities = {first};
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Wait, "No map yet", "the first one is queued"}));
  snapshot.traffic.activities.push_back(merged({}, 600));
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Quiet, "The merged map arrived", "no new map for 10 min; no map yet from uav9"}));
}

TEST(Verdict, TellsThatNoMapArrivesDuringAnOutage) {
  Snapshot snapshot = well(20);
  snapshot.traffic.endpoints[1].fault = EndpointFault::Silent;
  snapshot.traffic.endpoints[1].since = kNow - 72;
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Bad, "No map arrives", "for 1:12; the box keeps all maps"}));
  snapshot.traffic.endpoints[1].fault = EndpointFault::Throttling;
  EXPECT_EQ(verdict_of(snapshot).level, Level::Good) << "the endpoint accepts the maps";
}

TEST(Verdict, HasNoDurationIfTheTokenIsMissing) {
  Snapshot snapshot = well(3);
  snapshot.traffic.endpoints[1].fault = EndpointFault::NoToken;
  EXPECT_EQ(verdict_of(snapshot),
            (Verdict{Level::Bad, "No map arrives", "the mapping token is missing; the box keeps all maps"}));
}

TEST(Verdict, IsEmptyWithoutMaps) {
  EXPECT_EQ(verdict_of(well(0)),
            (Verdict{Level::Quiet, "No map yet", "no robot has sent one since the box started"}));
}

TEST(Verdict, TellsTheTimeSinceTheLastNewMap) {
  Snapshot snapshot = well(2);
  for (ActivityRow& row : snapshot.traffic.activities) row.heard = *row.heard + 600;
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Quiet, "Every map arrived", "no new map for 10 min"}));
}

TEST(Verdict, OmitsTheCountOfOneRobot) {
  EXPECT_EQ(verdict_of(busy(1)), (Verdict{Level::Good, "Every map arrives", "1 robot, 1 s"}));
}

TEST(Verdict, DoesNotCountTheMergedMapAsARobot) {
  Snapshot snapshot = busy(2);
  snapshot.traffic.activities.push_back(merged(9, 1));
  EXPECT_EQ(verdict_of(snapshot).why, "2 robots and the merged map, oldest 9 s");
  snapshot.traffic.activities = {merged(9, 1)};
  EXPECT_EQ(verdict_of(snapshot), (Verdict{Level::Good, "The merged map arrives", "9 s"}));
}

/// uav1's grid, with all other streams good.
class StandingTest : public testing::Test {
 protected:
  Standing standing() const { return standing_of(snapshot_.traffic.activities.front(), snapshot_.traffic); }
  void expect(Arrival arrival, Level level) const {
    EXPECT_EQ(standing().arrival, arrival);
    EXPECT_EQ(standing().level, level);
  }

  /// The stream with other times and another last answer.
  ActivityRow stream(std::optional<double> age, double heard, int status = 0,
                     const char* sentence = "") const {
    return {.kind = "grid",
            .robot = stream_.robot,
            .last_forwarded = kNow,
            .age = age,
            .heard = heard,
            .last_status = status,
            .last_sentence = sentence};
  }

  Snapshot snapshot_ = well(1);
  ActivityRow& stream_ = snapshot_.traffic.activities.front();
  RobotHabit& robot_ = snapshot_.traffic.habits.begin()->second;
  EndpointFault& mapping_ = snapshot_.traffic.endpoints[1].fault;
};

TEST_F(StandingTest, IsThatOfTheStreamWithoutOtherFaults) {
  expect(Arrival::UpToDate, Level::Good);
  robot_.silent = true;
  expect(Arrival::Silent, Level::Bad);
}

TEST_F(StandingTest, BlamesNoRobotWhileMappingIsDown) {
  for (const EndpointFault trouble :
       {EndpointFault::NoToken, EndpointFault::Unreachable, EndpointFault::Foreign, EndpointFault::Refusing,
        EndpointFault::Silent, EndpointFault::Failing}) {
    mapping_ = trouble;
    stream_ = stream(200, 200);
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = stream(3, 9, 0, "timed out");
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = stream({}, 9, 401);
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = stream(3, 9, 200);
    expect(Arrival::NotArriving, Level::Quiet);
    stream_ = stream({}, 3, 200);
    robot_.silent = true;
    expect(Arrival::UpToDate, Level::Good);
  }
}

TEST_F(StandingTest, BlamesNoRobotJustAfterAnOutage) {
  snapshot_.traffic.turn = 20;
  snapshot_.traffic.endpoints[1].well_for = 29;
  stream_ = stream(200, 200, 0, "timed out");
  expect(Arrival::Late, Level::Wait);
  stream_ = stream(60, 60, 401);
  expect(Arrival::Late, Level::Wait);
  stream_.last_status = 422;
  expect(Arrival::Refused, Level::Bad);
  stream_ = stream({}, 1, 200);
  expect(Arrival::UpToDate, Level::Good);
  robot_.silent = true;
  expect(Arrival::Silent, Level::Bad);
  robot_.silent = false;
  snapshot_.traffic.endpoints[1].well_for = 31;
  stream_ = stream(200, 200, 0, "timed out");
  expect(Arrival::NotArriving, Level::Bad);
}

TEST_F(StandingTest, BlamesTheRobotDuringScoringOutageOrThrottling) {
  stream_.age = 200;
  snapshot_.traffic.endpoints[0].fault = EndpointFault::Unreachable;
  expect(Arrival::NotArriving, Level::Bad);
  mapping_ = EndpointFault::Throttling;
  expect(Arrival::NotArriving, Level::Bad);
}

TEST_F(StandingTest, BlamesNoRobotForTheTeamCable) {
  robot_.silent = true;
  snapshot_.traffic.links = {{"team", "team0", false}};
  expect(Arrival::UpToDate, Level::Good);
  snapshot_.traffic.links.front().carrier = true;
  expect(Arrival::Silent, Level::Bad);
}

/// `heard` nullopt: never delivered.
ActivityRow of(const char* kind, std::optional<double> heard, int status = 200,
               std::optional<double> age = {}) {
  const auto forwarded = heard.transform([](double seconds) { return 1000 - seconds; });
  return {.kind = kind,
          .robot = "r",
          .last_forwarded = forwarded,
          .age = age,
          .heard = heard,
          .last_status = status};
}

const struct {
  const char* what;
  std::vector<ActivityRow> rows;
  const char* standing;
  bool silent = false;
  EndpointFault mapping = EndpointFault::None;
} kStandings[] = {
    {"worst kind, oldest map",
     {of("grid", 3), of("cloud", 4, 200, 33), of("state", 99, 200, 40)},
     "wait, 33 s behind, map 33 s, heard 3 s"},
    {"first of two as bad",
     {of("grid", 3, 422), of("cloud", 4)},
     "bad, rejected, silent, map -, heard 3 s",
     true},
    {"a quiet map beside another",
     {of("grid", 600), of("cloud", 4, 200, 2)},
     "good, arriving, map 2 s, heard 4 s"},
    {"two quiet maps",
     {of("grid", 600), of("cloud", 99), of("state", 70)},
     "quiet, quiet, map -, heard 1 min"},
    {"a map never delivered", {of("grid", {}), of("state", 4)}, "wait, waiting, map -, heard 4 s"},
    {"a second kind of map, never delivered",
     {of("grid", {}, 0, 9), of("cloud", 4)},
     "good, up to date, map 9 s, heard 4 s"},
    {"no map", {of("state", 4, 200, 1)}, "good, arriving, 1 s, heard 4 s"},
    {"nothing heard since the start", {}, "bad, silent, silent, -, heard 34 s", true},
    {"nothing heard while the endpoint is down", {}, "", true, EndpointFault::Silent},
};

std::string written(std::optional<double> seconds) {
  return seconds ? age_text(*seconds) : "-";
}

TEST(Words, ShowTheStandingOfARobot) {
  for (const auto& each : kStandings) {
    facts::Traffic traffic{.now = 1000,
                           .endpoints = {{.name = "mapping", .fault = each.mapping}},
                           .activities = each.rows,
                           .habits = {{"r", {.quiet = 34, .silent = each.silent}}}};
    traffic.activities.push_back({.kind = "grid", .last_forwarded = 996, .heard = 4});
    add_words(traffic, {});
    std::string standing;
    for (const auto& [name, level, word, silent, has_map, age, heard] : traffic.standings)
      standing += icd::sentence(facts::kLevelWords[static_cast<std::size_t>(level)], ", ", word,
                                silent ? ", silent, " : ", ", has_map ? "map " : "", written(age), ", heard ",
                                written(heard));
    EXPECT_EQ(standing, each.standing) << each.what;
  }
}

TEST(Words, ShowTheAgeOfAPoseNotOfItsDelivery) {
  facts::Traffic traffic{
      .now = 1000,
      .activities = {{.kind = "grid", .robot = "r", .last_accepted = 980, .last_forwarded = 990},
                     {.kind = "state", .robot = "r", .last_accepted = 906, .last_forwarded = 999}},
      .robots = {{.name = "r", .at = 999}, {.name = "later", .at = 1010}, {.name = "before"}}};
  add_words(traffic, {});
  EXPECT_EQ(traffic.robots[0].age, 94) << "the message was queued for long";
  EXPECT_EQ(traffic.robots[1].age, 0) << "an age is never negative";
  EXPECT_EQ(traffic.robots[2].age, std::nullopt) << "the time is from before the boot";
  traffic.activities[1].last_accepted = 999.5;
  add_words(traffic, {});
  EXPECT_EQ(traffic.robots[0].age, 1) << "a newer one is queued";
}

std::string word_of(const EndpointRow& row, const Snapshot& snapshot = {}) {
  facts::Traffic traffic{.endpoints = {row}};
  add_words(traffic, Board().to_alarms(conditions_of(snapshot), 0));
  const auto level = static_cast<std::size_t>(traffic.endpoints[0].level);
  return icd::sentence(facts::kLevelWords[level], " ", traffic.endpoints[0].word);
}

TEST(Words, ShowTheStandingOfAnEndpoint) {
  using enum EndpointFault;
  EndpointRow row{.name = "mapping"};
  EXPECT_EQ(word_of(row), "wait not connected");
  row.connected = true, row.trouble = "t";
  EXPECT_EQ(word_of(row), "wait retrying");
  row.last_status = 422;
  EXPECT_EQ(word_of(row), "wait status 422");
  row.trouble = "", row.last_status = 200, row.connected = false;
  const auto with_fault = [](const char* name, EndpointFault fault) {
    return Snapshot{.traffic = {.endpoints = {{.name = name, .fault = fault}}}};
  };
  row.waits = 4;
  EXPECT_EQ(word_of(row), "wait no answer yet");
  row.waits = 0;
  std::vector<std::string> all;
  for (const auto fault : {NoToken, Unreachable, Foreign, Refusing, Silent, Failing, Throttling})
    all.push_back(word_of(row, with_fault("mapping", fault)));
  EXPECT_THAT(all, testing::ElementsAre("bad no token", "bad unreachable", "bad wrong host", "bad rejected",
                                        "bad silent", "bad failing", "wait slow down"));
  EXPECT_EQ(word_of(row, with_fault("scoring", Silent)), "good connected");
  row.connected = true, row.last_status = 0;
  const auto without_link = [](const char* side) {
    return Snapshot{.traffic = {.links = {{side, "eth0", false}}}};
  };
  EXPECT_EQ(word_of(row, without_link("team")), "good connected");
  EXPECT_EQ(word_of(row, without_link("command_post")), "bad cable out");
  EXPECT_EQ(word_of(row, {.network = {.no_address = true}}), "bad no address");
  EXPECT_EQ(word_of(row, {.network = {.exchanged = facts::SwappedAddress{}}}), "bad cables exchanged");
}

}  // namespace
}  // namespace adit::alarms
