#include "rehearsal/robots/robot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace adit::robots {
namespace {

const Cave& cave() {
  static const Cave one = Cave::generate(4);
  return one;
}

/// The value of the grid's cell that lies at a lattice cell, or kUnknown outside of it.
std::uint8_t value_at(const Grid& grid, Cell cell) {
  const Lattice& lattice = cave().lattice();
  const int left = static_cast<int>(std::lround((grid.origin.position.x - lattice.left) / grid.resolution));
  const int bottom =
      static_cast<int>(std::lround((grid.origin.position.y - lattice.bottom) / grid.resolution));
  const int x = cell.x - left, y = cell.y - bottom;
  if (x < 0 || y < 0 || x >= static_cast<int>(grid.width) || y >= static_cast<int>(grid.height))
    return kUnknown;
  return grid.cells[static_cast<std::size_t>(y) * grid.width + static_cast<std::size_t>(x)];
}

TEST(Robot, WalksTheSameWayForTheSameSeed) {
  Robot a(cave(), 11, 1), b(cave(), 11, 1);
  for (int i = 0; i < 50; ++i) {
    a.advance(0.4);
    b.advance(0.4);
    ASSERT_EQ(a.pose(), b.pose());
  }
  EXPECT_EQ(a.map().take_new_points(0).data, b.map().take_new_points(0).data);
}

TEST(Robot, StaysOutOfTheRockAndWalksOn) {
  for (std::size_t index = 0; index < 3; ++index) {
    Robot robot(cave(), 5, index);
    for (int i = 0; i < 200; ++i) {
      robot.advance(1);
      const Vector3 at = robot.pose().position;
      ASSERT_TRUE(cave().is_open(cave().lattice().cell_at(at.x, at.y))) << at.x << " " << at.y;
    }
    EXPECT_GT(robot.walked_distance(), 180) << index;
  }
}

TEST(Robot, FindsMostArtifactsOnceEach) {
  Robot robot(cave(), 5, 0);
  std::vector<int> found(cave().artifacts().size(), 0);
  for (int i = 0; i < 400; ++i) {
    robot.advance(1.5);
    for (const std::size_t artifact : robot.take_sightings()) ++found[artifact];
  }
  EXPECT_GE(std::count(found.begin(), found.end(), 1), 15);
  EXPECT_EQ(std::count_if(found.begin(), found.end(), [](int times) { return times > 1; }), 0);
}

TEST(Robot, SeesTheFirstArtifactBeforeItMoves) {
  Robot robot(cave(), 5, 0);
  const std::vector<std::size_t> seen = robot.take_sightings();
  EXPECT_NE(std::find(seen.begin(), seen.end(), 0u), seen.end());
}

TEST(RobotMap, GrowsSoThatEachGridCoversThePrevious) {
  Robot robot(cave(), 6, 2);
  Grid before = robot.map().grid(0);
  for (int second = 1; second < 40; ++second) {
    for (int tick = 0; tick < 5; ++tick) robot.advance(0.4);
    const Grid now = robot.map().grid(second);
    ASSERT_EQ(now.cells.size(), std::size_t{now.width} * now.height);
    EXPECT_LE(now.origin.position.x, before.origin.position.x);
    EXPECT_LE(now.origin.position.y, before.origin.position.y);
    EXPECT_GE(now.origin.position.x + now.width * now.resolution + 1e-9,
              before.origin.position.x + before.width * before.resolution);
    EXPECT_GE(now.origin.position.y + now.height * now.resolution + 1e-9,
              before.origin.position.y + before.height * before.resolution);
    for (std::size_t i = 0; i < cave().lattice().size(); ++i) {
      const Cell cell = cave().lattice().cell_at(i);
      if (value_at(before, cell) != kUnknown) {
        ASSERT_NE(value_at(now, cell), kUnknown) << i;
      }
    }
    before = now;
  }
}

TEST(RobotMap, TellsRockFromOpenGround) {
  Robot robot(cave(), 6, 0);
  for (int i = 0; i < 100; ++i) robot.advance(0.4);
  const Grid grid = robot.map().grid(0);
  int known = 0;
  for (std::size_t i = 0; i < cave().lattice().size(); ++i) {
    const Cell cell = cave().lattice().cell_at(i);
    const std::uint8_t value = value_at(grid, cell);
    if (value == kUnknown) continue;
    ++known;
    ASSERT_LE(value, 100);
    ASSERT_EQ(value < 50, cave().is_open(cell)) << i;
  }
  EXPECT_GT(known, 3000);
}

TEST(RobotMap, GivesEachPointOnce) {
  Robot robot(cave(), 6, 0);
  const Cloud first = robot.map().take_new_points(1);
  EXPECT_EQ(first.point_step, 16u);
  EXPECT_GT(first.data.size(), 16u * 100);
  EXPECT_EQ(first.data.size() % 16, 0u);
  EXPECT_TRUE(robot.map().take_new_points(2).data.empty());
  robot.advance(0);
  EXPECT_TRUE(robot.map().take_new_points(3).data.empty()) << "nothing new to be seen from the same place";
}

TEST(RobotMap, MeasuresPointsBetweenFloorAndCeiling) {
  Robot robot(cave(), 6, 0);
  for (int i = 0; i < 20; ++i) robot.advance(0.4);
  const Cloud cloud = robot.map().take_new_points(1);
  for (std::size_t at = 0; at < cloud.data.size(); at += cloud.point_step) {
    float point[4];
    std::memcpy(point, cloud.data.data() + at, sizeof point);
    for (const float value : point) ASSERT_TRUE(std::isfinite(value));
    ASSERT_GT(point[2], -12);
    ASSERT_LT(point[2], 20);
    ASSERT_GT(point[3], 0);
  }
}

}  // namespace
}  // namespace adit::robots
