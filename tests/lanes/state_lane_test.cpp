#include "lanes/state_lane.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "lanes/maps.hpp"

namespace adit::lanes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;
using testing::SizeIs;

icd::NamedPose pose(const std::string& name, double x) {
  return {*robot(name), {{x, 0, 0}, {}}};
}

std::vector<PostedPose> state(std::optional<icd::Stamp> stamp, std::vector<icd::NamedPose> poses,
                              const std::string& address = "10.0.0.5") {
  return posted({{stamp}, std::move(poses)}, address);
}

void post(StateLane& lane, const std::vector<PostedPose>& poses, Instant now) {
  lane.add(lane.news_in(poses), now);
}

TEST(StateLane, SendsAllRobotsTogetherThoughEachPostsAlone) {
  StateLane lane;
  post(lane, state(10, {pose("R2", 2)}), at(1));
  post(lane, state(11, {pose("R1", 1)}), at(2));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 1), pose("R2", 2)));
  EXPECT_THAT(taken->update.header.stamp, Optional(11.0));
  EXPECT_EQ(taken->accepted, at(1));
}

TEST(StateLane, SendsRobotsWithoutNewsToo) {
  StateLane lane;
  post(lane, state(10, {pose("R1", 1), pose("R2", 2)}), at(1));
  lane.take();
  post(lane, state(12, {pose("R2", 3)}), at(2));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 1), pose("R2", 3)));
  EXPECT_THAT(taken->news, ElementsAre(pose("R2", 3)));
}

TEST(StateLane, GivesOutNothingWithoutNews) {
  StateLane lane;
  EXPECT_FALSE(lane.take());
  post(lane, state(10, {pose("R1", 1)}), at(1));
  EXPECT_FALSE(lane.empty());
  lane.take();
  EXPECT_TRUE(lane.empty());
  EXPECT_FALSE(lane.take());
}

struct OrderCase {
  const char* what;
  std::optional<icd::Stamp> held, newer;
  const char* address;  // of the newer one
  double x;             // that is kept: 1, which came first, or 2
};

class StateLaneOrder : public testing::TestWithParam<OrderCase> {};

TEST_P(StateLaneOrder, IsByTheStampsOfOneClientAndElseByArrival) {
  const OrderCase& given = GetParam();
  StateLane lane;
  post(lane, state(given.held, {pose("R1", 1)}), at(1));
  lane.passed(*lane.take());
  post(lane, state(given.newer, {pose("R1", 2)}, given.address), at(2));
  EXPECT_EQ(lane.empty(), given.x == 1) << "one that is older is no news";
  post(lane, state(1, {pose("R2", 0)}), at(3));
  EXPECT_THAT(lane.take()->update.poses, ElementsAre(pose("R1", given.x), pose("R2", 0)));
}

INSTANTIATE_TEST_SUITE_P(Table, StateLaneOrder,
                         testing::Values(OrderCase{"newer", 10, 11, "10.0.0.5", 2},
                                         OrderCase{"late", 10, 9, "10.0.0.5", 1},
                                         OrderCase{"the same", 10, 10, "10.0.0.5", 2},
                                         OrderCase{"of another client", 10, 9, "10.0.0.6", 2},
                                         OrderCase{"without a stamp", 10, {}, "10.0.0.5", 2},
                                         OrderCase{"after one without a stamp", {}, 9, "10.0.0.5", 2}),
                         [](const auto& test) {
                           std::string name = test.param.what;
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

TEST(StateLane, RepeatsNoPoseInARunThatItWasNotPostedIn) {
  StateLane lane;
  post(lane, state(10, {pose("R1", 1), pose("R2", 1)}), at(1));
  lane.passed(*lane.take());
  post(lane, state(11, {pose("R2", 2), pose("R3", 2)}), at(2));
  lane.begin_run();
  post(lane, state(12, {pose("R3", 3)}), at(3));
  const auto first = lane.take();
  EXPECT_THAT(first->update.poses, ElementsAre(pose("R2", 2), pose("R3", 3))) << "what waits is not lost";
  lane.passed(*first);
  post(lane, state(13, {pose("R4", 4)}), at(4));
  EXPECT_THAT(lane.take()->update.poses, ElementsAre(pose("R3", 3), pose("R4", 4)));
  EXPECT_THAT(lane.news_in(state(9, {pose("R1", 9)})), IsEmpty()) << "it came late";
}

TEST(StateLane, RepeatsAPoseOfTheRunBeforeOnlyUntilItIsTaken) {
  StateLane lane;
  post(lane, state(10, {pose("R1", 1)}), at(1));
  const auto under_way = *lane.take();
  lane.begin_run();
  lane.put_back(under_way);
  const auto again = lane.take();
  EXPECT_THAT(again->news, ElementsAre(pose("R1", 1)));
  post(lane, state(11, {pose("R1", 2)}), at(2));
  lane.passed(*again);
  lane.passed(*lane.take());
  post(lane, state(12, {pose("R2", 3)}), at(3));
  EXPECT_THAT(lane.take()->update.poses, ElementsAre(pose("R1", 2), pose("R2", 3))) << "it posted since";
}

TEST(StateLane, WhatIsPutBackIsNewsAgainAndNeverOverwritesNewer) {
  StateLane lane;
  post(lane, state(10, {pose("R1", 1), pose("R2", 1)}), at(1));
  const auto failed = *lane.take();
  post(lane, state(11, {pose("R1", 2)}), at(2));
  lane.put_back(failed);
  EXPECT_EQ(lane.oldest(), at(1));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 2), pose("R2", 1)));
  EXPECT_EQ(taken->accepted, at(1));
}

TEST(StateLane, HasAnEndToTheRobotsItKnows) {
  StateLane lane;
  icd::StateUpdate many;
  for (std::size_t i = 0; i < StateLane::kMostRobots; ++i) many.poses.push_back(pose(std::to_string(i), 0));
  EXPECT_TRUE(lane.has_room_for(many));
  lane.add(posted(many), at(1));
  EXPECT_FALSE(lane.has_room_for({{}, {pose("R1", 0)}}));
  EXPECT_TRUE(lane.has_room_for({{}, {pose("7", 0)}})) << "a robot that it knows";
}

TEST(StateLane, ShowsEachRobotsNewestPoseAndTellsEachNewsUntilItIsTakenHoweverSendingGoes) {
  std::mt19937_64 random{1};
  const auto pick = [&](int below) { return std::uniform_int_distribution{0, below - 1}(random); };
  StateLane lane;
  std::map<icd::RobotName, std::pair<icd::Stamp, double>> newest;
  std::map<icd::RobotName, double> lacking;  // at the Command Post
  int number = 0;
  const auto add = [&] {
    icd::StateUpdate update{{number + pick(5)}, {}};
    for (const char* name : {"R1", "R2", "R3"}) {
      if (pick(2) == 0) continue;
      update.poses.push_back(pose(name, number));
      auto& known = newest.try_emplace(*robot(name), -1, 0).first->second;
      if (*update.header.stamp < known.first) continue;
      known = {*update.header.stamp, number};
      lacking[*robot(name)] = number;
    }
    post(lane, posted(update), at(number));
    ++number;
  };
  for (int i = 0; i < 5000; ++i) {
    if (pick(2) == 0) add();
    ASSERT_EQ(lane.empty(), lacking.empty());
    auto taken = lane.take();
    if (!taken) continue;
    ASSERT_THAT(taken->update.poses, SizeIs(newest.size()));
    for (const auto& robot : taken->update.poses) {
      ASSERT_EQ(robot.pose.position.x, newest.at(robot.name).second);
    }
    std::map<icd::RobotName, double> told;
    for (const auto& news : taken->news) told[news.name] = news.pose.position.x;
    ASSERT_EQ(told, lacking);
    if (pick(3) != 0) lacking.clear();
    const bool is_taken = lacking.empty();
    if (pick(3) == 0) add();
    is_taken ? lane.passed(*taken) : lane.put_back(*taken);
  }
}

TEST(StateLane, ForgetsRobotsThatNobodyNeedBeToldOf) {
  StateLane lane;
  post(lane, state(10, {pose("R1", 1), pose("R2", 2)}), at(1));
  lane.passed(*lane.take());
  post(lane, state(12, {pose("R2", 3)}), at(2));
  lane.forget_what_was_taken();
  EXPECT_TRUE(lane.take());
  post(lane, state(13, {pose("R3", 4)}), at(3));
  EXPECT_THAT(lane.take()->update.poses, ElementsAre(pose("R2", 3), pose("R3", 4)));
}

}  // namespace
}  // namespace adit::lanes
