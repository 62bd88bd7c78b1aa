#include "picture/forwarded_grids.hpp"

#include <random>

#include "picture/maps.hpp"

namespace adit::picture {
namespace {

constexpr Area kNear{-1, -1, 1, 1};

icd::MapUpdate named(const std::string& robot, icd::MapUpdate map) {
  map.name = icd::RobotName::parse(robot);
  return map;
}

icd::MapUpdate square(double x, double y, std::uint32_t side, double resolution = 0.05,
                      std::uint8_t value = 0) {
  return grid_at(x, y, side, resolution, Cells(std::size_t{side} * side, value));
}

class ForwardedGridsTest : public testing::Test {
 protected:
  bool take(const icd::MapUpdate& map) {
    layer = layer_of(map);
    return grids.add(forwarded_grid(map), ++number);
  }
  std::size_t kept(const Area& area = kNear) const { return grids.grids_in(layer, area).size(); }

  ForwardedGrids grids;
  Layer layer;
  std::uint64_t number = 100;
};

TEST_F(ForwardedGridsTest, ReplaceGridsInsideThem) {
  take(square(0, 0, 20));
  take(square(-0.52, -0.51, 40));
  EXPECT_EQ(kept(), 1U) << "although on another lattice";
  take(square(0.3, 0.3, 20));
  EXPECT_EQ(kept(), 2U);
  const auto both = grids.grids_in(layer, kNear);
  EXPECT_EQ(std::get<icd::OccupancyGrid>(square(0.3, 0.3, 20).msg).origin, both.back()->grid.origin)
      << "in their order";
  EXPECT_EQ(kept({5, 5, 6, 6}), 0U);
  EXPECT_EQ(grids.newest_in(layer, kNear), number);
}

TEST_F(ForwardedGridsTest, TurnedGridReplacesGridsInsideIt) {
  const auto turned = [](std::uint32_t side, double x, double y, double angle) {
    return grid_of(side, 0.05, {{x, y, 0}, turned_by(angle)}, Cells(std::size_t{side} * side, 0));
  };
  take(turned(10, 0, 0, 0.785398));
  take(turned(40, 0.3, -0.7, 0.7854));
  EXPECT_EQ(kept(), 1U);
  take(turned(10, 0.4, -0.9, 0.785398));
  take(turned(40, 0.3, -0.7, 0.785398));
  EXPECT_EQ(kept({-1, -1, 2, 2}), 2U) << "a corner reaches out";
}

TEST_F(ForwardedGridsTest, CreepingWindowLeavesNoHole) {
  for (int i = 0; i < 50; ++i) take(square(0.01 * i, 0, 20));
  for (double x = 0.026; x < 1; x += 0.01) EXPECT_GE(kept({x, 0, x + 0.001, 1}), 1U) << x;
}

TEST_F(ForwardedGridsTest, RepeatedGridChangesNothing) {
  EXPECT_TRUE(take(square(0, 0, 20)));
  EXPECT_FALSE(take(gzipped(square(0, 0, 20))));
  EXPECT_EQ(grids.newest_in(layer, kNear), 101U);
  EXPECT_TRUE(take(square(0, 0, 20, 0.05, 100)));
}

TEST_F(ForwardedGridsTest, TellTheirResolutionAndChanges) {
  EXPECT_FALSE(grids.finer_levels({"ugv1", LayerKind::Grid}, 0));
  take(square(0, 0, 20, 0.2));
  EXPECT_EQ(grids.finer_levels(layer, 0)->level, -1);
  take(square(10, 0, 20, 0.05));
  EXPECT_EQ(grids.finer_levels(layer, 0)->level, -1);
  take(square(20, 0, 20, 0.02));
  const auto finer = grids.finer_levels(layer, 0);
  ASSERT_TRUE(finer && finer->area);
  EXPECT_EQ(finer->level, -2);
  EXPECT_EQ(finer->version, number);
  EXPECT_EQ(*finer->area, (Area{0, 0, 20.4, 4}));
  EXPECT_EQ(*grids.finer_levels(layer, 102)->area, (Area{20, 0, 20.4, 0.4}));
  EXPECT_FALSE(grids.finer_levels(layer, 103)->area);
}

TEST_F(ForwardedGridsTest, CoarseGridsAreNotKeptAlone) {
  EXPECT_FALSE(take(square(0, 0, 20, 0.25)));
  EXPECT_EQ(grids.bytes(), 0U);
  take(square(0, 0, 20, 0.1));
  EXPECT_TRUE(take(square(0.5, 0, 20, 0.25))) << "the grid covers the other one";
  EXPECT_EQ(kept(), 2U);
  EXPECT_EQ(forwarded_grid(cloud_of({{0, 0, 0}})), nullptr);
}

TEST_F(ForwardedGridsTest, DroppedGridRemovesOlderOnesInItsPlace) {
  std::mt19937_64 random{23};
  Cells noise(std::size_t{2400} * 2400);
  for (auto& cell : noise) cell = static_cast<std::uint8_t>(random() % 101);
  const auto large = grid_at(0, 0, 2400, 0.05, noise);
  for (const auto& map : {large, gzipped(large), square(0, 0, 20, 1)}) {
    EXPECT_FALSE(take(map)) << "no finer cells existed";
    take(square(0, 0, 20));
    EXPECT_TRUE(take(map));
    EXPECT_FALSE(grids.finer_levels(layer, 0));
    EXPECT_EQ(grids.bytes(), 0U);
  }
}

TEST_F(ForwardedGridsTest, StayWithinTheBudgetAndDropTheOldest) {
  std::mt19937_64 random{24};
  Cells noise(300 * 300);
  for (auto& cell : noise) cell = static_cast<std::uint8_t>(random() % 101);
  auto map = gzipped(grid_at(0, 0, 300, 0.05, noise));
  for (int i = 0; i < 600; ++i) {
    std::get<icd::OccupancyGrid>(map.msg).origin.position.x = i;
    take(named("r" + std::to_string(i % 20), map));
    ASSERT_LE(grids.bytes(), ForwardedGrids::kBudget);
  }
  EXPECT_GT(grids.bytes(), ForwardedGrids::kBudget * 9 / 10);
  EXPECT_EQ(grids.grids_in({"r0", LayerKind::Grid}, {0, 0, 10, 10}).size(), 0U) << "the first one";
  EXPECT_EQ(grids.grids_in({"r19", LayerKind::Grid}, {599, 0, 600, 10}).size(), 1U) << "the last one";
  grids.clear();
  EXPECT_EQ(grids.bytes(), 0U);
}

TEST_F(ForwardedGridsTest, LimitTheCellsReadForABlock) {
  for (int i = 0; i < 6; ++i) {
    ForwardedGrid grid = *forwarded_grid(square(-0.3 * i, 0, 20));
    grid.data.raw_size = ForwardedGrids::kMostCells / 4;  // as if it had that many
    layer = grid.layer;
    grids.add(std::make_shared<const ForwardedGrid>(std::move(grid)), ++number);
  }
  const auto some = grids.grids_in(layer, kNear);
  ASSERT_EQ(some.size(), 4U);
  EXPECT_EQ(some.back()->grid.origin.position.x, -1.5) << "the last ones";
}

TEST_F(ForwardedGridsTest, ReleaseTheBufferOfTheirMessage) {
  auto map = gzipped(square(0, 0, 20));
  const std::vector<std::uint8_t> bytes = map.data.bytes.to_vector();
  auto released = std::make_shared<std::vector<std::uint8_t>>(bytes);
  const std::weak_ptr<std::vector<std::uint8_t>> watch = released;
  map.data.bytes = {};
  map.data.bytes.append(released, *released);
  const auto grid = forwarded_grid(map);
  map.data.bytes = {};
  released.reset();
  EXPECT_TRUE(watch.expired()) << "the grid's file must be released";
  EXPECT_EQ(grid->data.bytes.to_vector(), bytes);
}

}  // namespace
}  // namespace adit::picture
