#include "picture/coverage.hpp"

#include <gmock/gmock.h>

#include <random>
#include <set>

#include "picture/maps.hpp"

namespace adit::picture {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

icd::MapUpdate of(const std::string& robot, icd::MapUpdate map) {
  map.name = icd::RobotName::parse(robot);
  return map;
}

/// A square of free 0.25 m cells. One cell is one pixel.
icd::MapUpdate square(const std::string& robot, double x, double y, std::uint32_t side) {
  return of(robot, grid_at(x, y, side, 0.25, Cells(std::size_t{side} * side, 0)));
}

Coverage covered(const Mosaic& mosaic) {
  CoveredArea area;
  area.update(area.changes(mosaic));
  return area.now();
}

TEST(CoveredArea, CountsKnownCellsOnly) {
  Easel easel;
  easel.draw(grid_at(0, 0, 3, 0.25, {0, kUnknown, 100, kUnknown, 50, kUnknown}));
  const Coverage seen = covered(easel.mosaic);
  EXPECT_EQ(seen.all, 3);
  EXPECT_THAT(seen.of, ElementsAre(Pair("ugv1", 3)));
  EXPECT_TRUE(seen.is_whole);
  EXPECT_EQ(seen.version, easel.mosaic.version());
}

/// Two squares of 8 x 8 cells with 4 x 8 in common, across the border of two tiles.
TEST(CoveredArea, CountsAPlaceOfTwoRobotsOnce) {
  Easel easel;
  easel.draw(square("ugv1", 63, 0, 8));
  easel.draw(square("uav1", 64, 0, 8));
  const Coverage seen = covered(easel.mosaic);
  EXPECT_EQ(seen.all, 64 + 64 - 32);
  EXPECT_THAT(seen.of, ElementsAre(Pair("uav1", 64), Pair("ugv1", 64)));
}

TEST(CoveredArea, OmitsRobotsWithOnlyClouds) {
  Easel easel;
  easel.draw(cloud_of({{1, 1, 0}, {2, 2, 0}}));
  const Coverage seen = covered(easel.mosaic);
  EXPECT_EQ(seen.all, 0);
  EXPECT_THAT(seen.of, IsEmpty());
}

TEST(CoveredArea, ForgetsAnEarlierRun) {
  Easel easel;
  CoveredArea area;
  easel.draw(square("ugv1", 0, 0, 8));
  area.update(area.changes(easel.mosaic));
  easel.mosaic.wipe(++easel.now);
  area.update(area.changes(easel.mosaic));
  EXPECT_EQ(area.now().all, 0);
  EXPECT_THAT(area.now().of, IsEmpty());
}

TEST(CoveredArea, IsIncompleteIfAGridIsMissing) {
  Easel easel;
  easel.draw(square("ugv1", 0, 0, 8));
  easel.mosaic.on_missed({"uav1", LayerKind::Cloud}, 2000);
  EXPECT_TRUE(covered(easel.mosaic).is_whole);
  easel.mosaic.on_missed({"uav1", LayerKind::Grid}, 2001);
  EXPECT_FALSE(covered(easel.mosaic).is_whole);
}

TEST(CoveredArea, CountsChangedPlacesOnly) {
  Easel easel;
  CoveredArea area;
  easel.draw(square("ugv1", 0, 0, 8));
  easel.draw(square("uav1", 640, 0, 8));
  area.update(area.changes(easel.mosaic));
  EXPECT_THAT(area.changes(easel.mosaic).places, IsEmpty());
  easel.draw(square("ugv1", 10, 0, 8));
  EXPECT_THAT(area.changes(easel.mosaic).places, ElementsAre(Pair(TileIndex{0, 0, 0}, testing::SizeIs(1))));
}

/// Compares with a set of pixels, for any maps and any times of counting.
TEST(CoveredArea, IsTheUnionOfAllSquares) {
  std::mt19937 random{7};
  const auto below = [&](unsigned most) { return random() % most; };
  Easel easel;
  CoveredArea area;
  std::set<std::pair<int, int>> all;
  std::map<std::string, std::set<std::pair<int, int>>> own;
  for (int i = 0; i < 60; ++i) {
    const std::string robot = std::string("r") + static_cast<char>('0' + below(3));
    const int x = static_cast<int>(below(600)) - 300, y = static_cast<int>(below(600)) - 300;
    const auto side = static_cast<int>(1 + below(40));
    easel.draw(square(robot, x * 0.25, y * 0.25, static_cast<std::uint32_t>(side)));
    for (int cell = 0; cell < side * side; ++cell) {
      const std::pair at{x + cell % side, y + cell / side};
      all.insert(at);
      own[robot].insert(at);
    }
    if (below(4) != 0) continue;
    area.update(area.changes(easel.mosaic));
    EXPECT_EQ(area.now().all, all.size());
  }
  area.update(area.changes(easel.mosaic));
  for (const auto& [robot, known] : area.now().of) EXPECT_EQ(known, own[robot].size()) << robot;
  EXPECT_EQ(area.now().of.size(), own.size());
  EXPECT_EQ(covered_over_time(easel.mosaic).back().second, all.size());
}

TEST(CoveredOverTime, GrowsWithEachLargerGrid) {
  Easel easel;
  easel.draw(square("ugv1", 0, 0, 8));
  easel.draw(square("uav1", 1, 0, 8));
  easel.draw(square("ugv1", 640, 0, 8));
  EXPECT_THAT(covered_over_time(easel.mosaic), ElementsAre(Pair(1001, 64), Pair(1002, 96), Pair(1003, 160)));
  EXPECT_THAT(covered_over_time(Mosaic()), IsEmpty());
}

}  // namespace
}  // namespace adit::picture
