#include "lanes/state_lane.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>
#include <string>

#include "lanes/maps.hpp"

namespace adit::lanes {
namespace {

using testing::ElementsAre;
using testing::Optional;
using testing::SizeIs;

icd::NamedPose pose(const std::string& name, double x) {
  return {*robot(name), {{x, 0, 0}, {}}};
}

icd::StateUpdate state(std::optional<icd::Stamp> stamp, std::vector<icd::NamedPose> poses) {
  return {{stamp}, std::move(poses)};
}

TEST(StateLane, SendsAllRobotsTogetherThoughEachPostsAlone) {
  StateLane lane;
  lane.add(state(10, {pose("R2", 2)}), at(1));
  lane.add(state(11, {pose("R1", 1)}), at(2));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 1), pose("R2", 2)));
  EXPECT_THAT(taken->update.header.stamp, Optional(11.0));
  EXPECT_EQ(taken->updates, 2);
  EXPECT_EQ(taken->accepted, at(1));
}

TEST(StateLane, SendsRobotsWithoutNewsToo) {
  StateLane lane;
  lane.add(state(10, {pose("R1", 1), pose("R2", 2)}), at(1));
  lane.take();
  lane.add(state(12, {pose("R2", 3)}), at(2));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 1), pose("R2", 3)));
  EXPECT_EQ(taken->updates, 1);
}

TEST(StateLane, GivesOutNothingWithoutNews) {
  StateLane lane;
  EXPECT_FALSE(lane.take());
  lane.add(state(10, {pose("R1", 1)}), at(1));
  EXPECT_FALSE(lane.empty());
  lane.take();
  EXPECT_TRUE(lane.empty());
  EXPECT_FALSE(lane.take());
}

TEST(StateLane, KeepsThePoseWithTheNewerStamp) {
  StateLane lane;
  lane.add(state(10, {pose("R1", 1)}), at(1));
  lane.add(state(9, {pose("R1", 2)}), at(2));  // late
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 1)));
  EXPECT_EQ(taken->updates, 2);
}

TEST(StateLane, TakesTheLaterOfTwoPosesWhereStampsDoNotTell) {
  StateLane lane;
  lane.add(state(10, {pose("R1", 1), pose("R2", 1)}), at(1));
  lane.add(state(10, {pose("R1", 2)}), at(2));
  lane.add(state({}, {pose("R2", 2)}), at(3));
  EXPECT_THAT(lane.take()->update.poses, ElementsAre(pose("R1", 2), pose("R2", 2)));
}

TEST(StateLane, WhatIsPutBackIsNewsAgainAndNeverOverwritesNewer) {
  StateLane lane;
  lane.add(state(10, {pose("R1", 1), pose("R2", 1)}), at(1));
  const auto failed = *lane.take();
  lane.add(state(11, {pose("R1", 2)}), at(2));
  lane.put_back(failed);
  EXPECT_EQ(lane.oldest(), at(1));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 2), pose("R2", 1)));
  EXPECT_EQ(taken->updates, 2);
  EXPECT_EQ(taken->accepted, at(1));
}

TEST(StateLane, HasAnEndToTheRobotsItKnows) {
  StateLane lane;
  icd::StateUpdate many;
  for (std::size_t i = 0; i < StateLane::kMostRobots; ++i) many.poses.push_back(pose(std::to_string(i), 0));
  EXPECT_TRUE(lane.has_room_for(many));
  lane.add(many, at(1));
  EXPECT_FALSE(lane.has_room_for(state(1, {pose("R1", 0)})));
  EXPECT_TRUE(lane.has_room_for(state(1, {pose("7", 0)}))) << "a robot that it knows";
}

TEST(StateLane, ShowsEachRobotsNewestPoseAndCountsEveryUpdateOnceHoweverSendingGoes) {
  std::mt19937_64 random{1};
  const auto pick = [&](int below) { return std::uniform_int_distribution{0, below - 1}(random); };
  StateLane lane;
  std::map<icd::RobotName, std::pair<icd::Stamp, double>> newest;
  std::uint64_t out = 0;
  std::uint64_t number = 0;
  const auto add = [&] {
    icd::StateUpdate update = state(number + pick(5), {});
    for (const char* name : {"R1", "R2", "R3"}) {
      if (pick(2) == 0) continue;
      update.poses.push_back(pose(name, static_cast<double>(number)));
      auto& known = newest.try_emplace(*robot(name), -1, 0).first->second;
      if (*update.header.stamp >= known.first) known = {*update.header.stamp, static_cast<double>(number)};
    }
    lane.add(update, at(static_cast<double>(number)));
    ++number;
  };
  for (int i = 0; i < 5000; ++i) {
    if (pick(2) == 0) add();
    auto taken = lane.take();
    if (!taken) continue;
    ASSERT_THAT(taken->update.poses, SizeIs(newest.size()));
    for (const auto& robot : taken->update.poses) {
      ASSERT_EQ(robot.pose.position.x, newest.at(robot.name).second);
    }
    if (pick(3) == 0) add();
    if (pick(3) == 0) {
      lane.put_back(*taken);
    } else {
      out += taken->updates;
    }
  }
  if (const auto rest = lane.take()) out += rest->updates;
  ASSERT_EQ(out, number);
}

TEST(StateLane, ForgetsRobotsThatNobodyNeedBeToldOf) {
  StateLane lane;
  lane.add(state(10, {pose("R1", 1), pose("R2", 2)}), at(1));
  lane.passed(*lane.take());
  lane.add(state(12, {pose("R2", 3)}), at(2));
  lane.forget_what_was_taken();
  EXPECT_TRUE(lane.take());
  lane.add(state(13, {pose("R3", 4)}), at(3));
  EXPECT_THAT(lane.take()->update.poses, ElementsAre(pose("R2", 3), pose("R3", 4)));
}

}  // namespace
}  // namespace adit::lanes
