#include "forward/delivered_scene.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "icd/sentence.hpp"

namespace adit::forward {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

std::vector<icd::NamedPose> state(const std::string& robot, double x, icd::Quaternion orientation = {}) {
  return {{*icd::RobotName::parse(robot), {{x, 2, 3}, orientation}}};
}

TEST(DeliveredScene, HasTheLastPoseOfEachRobot) {
  DeliveredScene all;
  all.on_forwarded(state("b", 1), 100);
  all.on_forwarded(state("a", 5, {0, 0, M_SQRT1_2, M_SQRT1_2}), 101);
  all.on_forwarded(state("b", 4), 102);
  const auto robots = all.robots();
  ASSERT_THAT(robots, SizeIs(2));
  EXPECT_EQ(robots[0].name, "a");
  EXPECT_NEAR(robots[0].heading, M_PI / 2, 1e-9);
  EXPECT_EQ(robots[1].position.x, 4);
  EXPECT_EQ(robots[1].at, 102);
  EXPECT_THAT(all.tracks().tracks_after(0), SizeIs(2));
}

TEST(DeliveredScene, StartsEmptyInANewRun) {
  DeliveredScene all;
  all.on_forwarded(state("a", 1), 100);
  all.on_forwarded(std::vector{icd::Marker{}}, 100);
  all.begin_run(200);
  EXPECT_THAT(all.robots(), SizeIs(1)) << "robots keep their places";
  EXPECT_THAT(all.tracks().tracks_after(0), IsEmpty());
  EXPECT_THAT(all.markers().changes(0).markers, IsEmpty());
}

TEST(DeliveredScene, KeepsItsAgesAtAClockStep) {
  for (const double step : {3e8, -3e8}) {
    DeliveredScene all;
    all.on_forwarded(state("a", 1), 1e9);
    all.on_forwarded(std::vector{icd::Marker{}}, 1e9);
    all.move(step);
    EXPECT_EQ(all.robots().at(0).at, 1e9 + step);
    EXPECT_EQ(all.tracks().tracks_after(0).at(0).poses.at(0).at, 1e9 + step);
    EXPECT_EQ(all.markers().changes(0).markers.at(0).at, 1e9 + step);
  }
}

TEST(DeliveredScene, DropsTheRobotThatWasSilentLongest) {
  DeliveredScene all;
  all.on_forwarded(state("ours", 1), 99);
  for (int i = 0; i < 300; ++i) {
    all.on_forwarded(state(icd::sentence("r", i), i), 100 + i);
    if (i % 50 == 0) all.on_forwarded(state("ours", i), 100 + i);
  }
  const auto robots = all.robots();
  EXPECT_THAT(robots, SizeIs(DeliveredScene::kMostRobots));
  EXPECT_THAT(all.tracks().tracks_after(0), SizeIs(DeliveredScene::kMostRobots));
  EXPECT_EQ(std::ranges::count(robots, "ours", &facts::RobotRow::name), 1);
  EXPECT_EQ(std::ranges::count(robots, "r0", &facts::RobotRow::name), 0);
}

}  // namespace
}  // namespace adit::forward
