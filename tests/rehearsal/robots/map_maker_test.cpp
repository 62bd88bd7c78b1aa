#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "rehearsal/robots/robot.hpp"

namespace adit::robots {
namespace {

const Cave& mine() {
  static const Cave one = Cave::generate(4);
  return one;
}

/// A robot that has walked, and what makes its maps.
struct Maker {
  explicit Maker(const MapOffer& offer) : maker(offer, 1) { walk(); }
  void walk() {
    for (int i = 0; i < 20; ++i) robot.advance(0.4);
  }
  std::optional<Grid> grid() { return maker.grid(robot.map(), robot.pose().position, time); }
  std::optional<Cloud> cloud() { return maker.cloud(robot.map(), robot.pose().position, time); }

  Robot robot{mine(), 6, 0};
  MapMaker maker;
  MapTime time{.stamp = 5, .posted = Moment(std::chrono::milliseconds(1'700'000'000'123))};
};

std::uint32_t date_of(const Cloud& cloud, std::size_t point) {
  std::uint32_t date = 0;
  std::memcpy(&date, &cloud.data[point * cloud.point_step + cloud.point_step - sizeof date], sizeof date);
  return date;
}

TEST(MapMaker, DatesAGridInItsFirstCells) {
  Maker team({});
  const auto grid = team.grid();
  ASSERT_TRUE(grid);
  std::uint64_t date = 0;
  for (std::size_t i = 5; i < 10; ++i) date = date * 101 + grid->cells[i];
  EXPECT_EQ(date, 1'700'000'000'123u % 10'510'100'501u);
}

TEST(MapMaker, CorrectsTheFrameOfDriftingGrids) {
  Maker team({.grids = GridForm::Drifting, .grid_bytes = 2'400'000}), still({.grid_bytes = 2'400'000});
  const Placement at = still.grid()->origin;
  EXPECT_EQ(team.grid()->origin, at);
  const auto moved = team.grid();
  EXPECT_DOUBLE_EQ(moved->resolution, 0.05);
  EXPECT_NEAR(moved->origin.position.x - at.position.x, 0.013, 1e-9);
  EXPECT_NEAR(moved->origin.orientation.z, 0.5e-9, 1e-15);
  EXPECT_NEAR(team.grid()->origin.position.y - at.position.y, 0.013, 1e-9);
  team.grid();
  EXPECT_NEAR(team.grid()->origin.position.z - at.position.z, 0.001, 1e-9);
}

TEST(MapMaker, DatesEachPointOfACloud) {
  Maker team({});
  const auto cloud = team.cloud();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->point_step, 20u);
  EXPECT_EQ(cloud->fields.back(), (CloudField{"posted_ms", 16, 6, 1}));
  EXPECT_EQ(date_of(*cloud, 0), static_cast<std::uint32_t>(1'700'000'000'123));
  EXPECT_FALSE(team.cloud()) << "no point is new";
}

TEST(MapMaker, KeepsTheDatesOfPointsInAWholeCloud) {
  Maker team({.clouds = CloudForm::Whole, .cloud_bytes = 200'000});
  const Cloud first = *team.cloud();
  EXPECT_GE(first.data.size(), 199'000u);
  team.time.posted += std::chrono::milliseconds(100);
  const Cloud second = *team.cloud();
  ASSERT_GT(second.data.size(), first.data.size());
  EXPECT_EQ(std::memcmp(first.data.data(), second.data.data(), first.data.size()), 0);
  EXPECT_EQ(date_of(second, second.data.size() / 20 - 1), date_of(first, 0) + 100);
}

TEST(MapMaker, FillsADifferentialCloudEachTime) {
  Maker team({.cloud_bytes = 100'000});
  EXPECT_GE(team.cloud()->data.size(), 99'000u);
  EXPECT_GE(team.cloud()->data.size(), 99'000u);
}

TEST(MapMaker, MakesAGridAsFineAsItIsLarge) {
  Maker plain({}), fine({.grid_bytes = 5'000'000});
  const Grid grid = *plain.grid(), larger = *fine.grid();
  EXPECT_EQ(larger.width, 6 * grid.width);
  EXPECT_EQ(larger.cells.size(), 36 * grid.cells.size());
  EXPECT_DOUBLE_EQ(larger.resolution, grid.resolution / 6);
  EXPECT_EQ(larger.cells.back(), grid.cells.back());
}

TEST(MapMaker, RollsAWindowWithTheRobot) {
  Maker team({.grids = GridForm::Rolling});
  const Grid grid = *team.grid();
  EXPECT_EQ(grid.width, 50u);
  EXPECT_EQ(grid.height, 50u);
  EXPECT_NEAR(grid.origin.position.x + 5, team.robot.pose().position.x, 0.21);
}

TEST(MapMaker, PostsEachKnownTileInTurn) {
  Maker team({.grids = GridForm::Tiles});
  const Cell low = team.robot.map().low(), high = team.robot.map().high();
  const int tiles = (high.x / 40 - low.x / 40 + 1) * (high.y / 40 - low.y / 40 + 1);
  ASSERT_GT(tiles, 1);
  const Grid first = *team.grid();
  EXPECT_EQ(first.width, 40u);
  for (int i = 1; i < tiles; ++i) EXPECT_NE(team.grid()->origin, first.origin);
  EXPECT_EQ(team.grid()->origin, first.origin);
}

TEST(MapMaker, MakesNoMapsOfFormNone) {
  Maker team({.grids = GridForm::None, .clouds = CloudForm::None});
  EXPECT_FALSE(team.grid());
  EXPECT_FALSE(team.cloud());
}

}  // namespace
}  // namespace adit::robots
