#include "icd/grid_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "icd/geometry.hpp"

namespace adit::icd {
namespace {

constexpr double kCell = 0.05;

OccupancyGrid grid(double x, double y, std::uint32_t width, std::uint32_t height, double resolution = kCell) {
  OccupancyGrid grid;
  grid.resolution = resolution;
  grid.width = width;
  grid.height = height;
  grid.origin.position = {x, y, 0};
  return grid;
}

OccupancyGrid with_z(OccupancyGrid grid, double z) {
  grid.origin.position.z = z;
  return grid;
}

/// Turned about its lower left corner.
OccupancyGrid turned(OccupancyGrid grid, double angle) {
  grid.origin.orientation = {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
  return grid;
}

OccupancyGrid tilted(OccupancyGrid grid, double angle) {
  grid.origin.orientation = {std::sin(angle / 2), 0, 0, std::cos(angle / 2)};
  return grid;
}

TEST(CoveredPart, IsWhatANewerGridCovers) {
  const OccupancyGrid older = grid(0, 0, 100, 100);
  const auto part = [&](const OccupancyGrid& newer) {
    return covered_part(GridBounds::from_grid(newer), older);
  };
  const auto shifted = part(grid(1, -1, 60, 40));
  ASSERT_TRUE(shifted);
  EXPECT_NEAR(shifted->low.x, 1, 1e-9);
  EXPECT_NEAR(shifted->high.x, 4, 1e-9);
  EXPECT_NEAR(shifted->low.y, -1, 1e-9);
  EXPECT_NEAR(shifted->high.y, 1, 1e-9);
  EXPECT_TRUE(part(with_z(grid(0, 0, 10, 10), 0.4 * kCell)));
  EXPECT_FALSE(part(with_z(grid(0, 0, 10, 10), 0.6 * kCell)));
  EXPECT_TRUE(part(turned(grid(0, 0, 10, 10), 1e-3)));
  EXPECT_FALSE(part(turned(grid(0, 0, 100, 100), 0.1)));
  EXPECT_FALSE(part(grid(0, 0, 10, 10, 2 * kCell)));
}

struct CoverCase {
  const char* what;
  OccupancyGrid newer, older;
  bool covered;
};

TEST(GridBounds, AreCoveredAsInTheTable) {
  const double far = 1e300;
  const CoverCase cases[] = {
      {"the same extent", grid(-5, 3, 40, 30), grid(-5, 3, 40, 30), true},
      {"grown on every side", grid(-1, -1, 80, 80), grid(0, 0, 40, 30), true},
      {"grown to the right only", grid(0, 0, 41, 30), grid(0, 0, 40, 30), true},
      {"one cell less to the right", grid(0, 0, 39, 30), grid(0, 0, 40, 30), false},
      {"one cell less at the top", grid(0, 0, 40, 29), grid(0, 0, 40, 30), false},
      {"one cell less to the left", grid(0.05, 0, 80, 80), grid(0, 0, 40, 30), false},
      {"one cell less at the bottom", grid(0, 0.05, 80, 80), grid(0, 0, 40, 30), false},
      {"larger, on another lattice", grid(-1.017, -1.031, 80, 80), grid(0, 0, 40, 30), true},
      {"a quarter of a cell off", grid(0.0125, -0.0125, 40, 30), grid(0, 0, 40, 30), true},
      {"half a cell off", grid(0.025, 0, 40, 30), grid(0, 0, 40, 30), true},
      {"more than half a cell off to the left", grid(0.026, 0, 80, 80), grid(0, 0, 40, 30), false},
      {"more than half a cell off to the right", grid(-0.026, 0, 40, 30), grid(0, 0, 40, 30), false},
      {"more than half a cell off at the bottom", grid(0, 0.026, 80, 80), grid(0, 0, 40, 30), false},
      {"more than half a cell off at the top", grid(0, -0.026, 40, 30), grid(0, 0, 40, 30), false},
      {"finer", grid(0, 0, 400, 400, 0.025), grid(0, 0, 40, 30), false},
      {"coarser", grid(-1, -1, 400, 400, 0.1), grid(0, 0, 40, 30), false},
      {"a millimetre higher", with_z(grid(0, 0, 40, 30), 0.001), grid(0, 0, 40, 30), true},
      {"half a cell lower", with_z(grid(0, 0, 40, 30), -0.025), grid(0, 0, 40, 30), true},
      {"more than half a cell higher", with_z(grid(-1, -1, 80, 80), 0.026), grid(0, 0, 40, 30), false},
      {"more than half a cell lower", with_z(grid(-1, -1, 80, 80), -0.026), grid(0, 0, 40, 30), false},
      {"turned by a jitter", turned(grid(0, 0, 4000, 4000), 1e-9), grid(0, 0, 4000, 4000), true},
      {"turned so that a corner moves by a quarter of a cell", turned(grid(-1, -1, 80, 80), 0.01),
       grid(0, 0, 40, 30), true},
      {"turned so that a corner moves by more", turned(grid(-9, -9, 800, 800), 0.05), grid(0, 0, 40, 30),
       false},
      {"turned right round", turned(grid(10, 10, 400, 400), std::numbers::pi), grid(0, 0, 40, 30), false},
      {"tilted by a jitter", tilted(grid(0, 0, 400, 400), 1e-4), grid(0, 0, 400, 400), true},
      {"tilted so that its far side is higher", tilted(grid(0, 0, 400, 400), 2e-3), grid(0, 0, 400, 400),
       false},
      {"so far out that cells cannot be told apart, alike", grid(far, 0, 80, 80), grid(far, 0, 40, 30), true},
      {"so far out, smaller", grid(far, 0, 39, 80), grid(far, 0, 40, 30), false},
      {"so far out, elsewhere", grid(far, 0, 80, 80), grid(far * 2, 0, 40, 30), false},
      {"on the two far sides", grid(-1e308, 0, 80, 80), grid(1e308, 0, 40, 30), false},
      {"far out and near", grid(0, 0, 80, 80), grid(far, 0, 40, 30), false},
      {"the widest there can be", grid(0, 0, 4294967295u, 4294967295u), grid(0, 0, 4294967295u, 1), true},
      {"a resolution that overflows", grid(1, 1, 2, 2, 5e-324), grid(1, 1, 1, 1, 5e-324), true},
  };
  for (const auto& [what, newer, older, covered] : cases)
    EXPECT_EQ(covers(newer, GridBounds::from_grid(older)), covered) << what;
}

TEST(GridBounds, AcceptAResolutionRoundedToFloat32) {
  const double resolution = static_cast<double>(0.05F);  // 0.05000000074505806
  for (int cells = 1; cells < 4000; cells += 7) {
    const auto older = grid(-10, -10, 100, 100, resolution);
    const auto newer = grid(-10 - cells * 0.05, -10, 8192, 100, resolution);
    EXPECT_TRUE(covers(newer, GridBounds::from_grid(older))) << cells << " cells apart";
  }
}

/// The number of grids in a row, each replacing the one before, until one does not.
template <class Next>
int replaced_in_a_row(OccupancyGrid grid, Next next, int most = 1000) {
  auto bounds = GridBounds::from_grid(grid);
  for (int count = 0; count < most; ++count) {
    const OccupancyGrid newer = next(grid, count);
    if (!covers(newer, bounds)) return count;
    bounds = joint_bounds(GridBounds::from_grid(newer), bounds);
    grid = newer;
  }
  return most;
}

TEST(GridBounds, KeepWhatACreepingWindowLeavesBehind) {
  const auto creep = [](double x, double y, double z) {
    return [=](OccupancyGrid grid, int) {
      grid.origin.position = {grid.origin.position.x + x, grid.origin.position.y + y,
                              grid.origin.position.z + z};
      return grid;
    };
  };
  EXPECT_EQ(replaced_in_a_row(grid(0, 0, 200, 200), creep(0.01, 0, 0)), 2) << "25 mm are half a cell";
  EXPECT_EQ(replaced_in_a_row(grid(0, 0, 200, 200), creep(-0.01, 0, 0)), 2);
  EXPECT_EQ(replaced_in_a_row(grid(0, 0, 200, 200), creep(0, 0.001, 0)), 25);
  EXPECT_EQ(replaced_in_a_row(grid(0, 0, 200, 200), creep(0, 0, 0.001)), 25);
  EXPECT_EQ(replaced_in_a_row(turned(grid(3, -7, 200, 200), 0.7), creep(0.001, 0, 0)), 32)
      << "25 mm along the axes of the grid";
}

TEST(GridBounds, KeepTheTurnsOfAGridThatTurnsInALargerOne) {
  const auto about_the_middle = [](int count, double angle) {
    const std::uint32_t side = 20 + 4 * static_cast<std::uint32_t>(count);
    const double half = side * kCell / 2, x = half * (std::cos(angle) - std::sin(angle)),
                 y = half * (std::sin(angle) + std::cos(angle));
    return turned(grid(-x, -y, side, side), angle);
  };
  const auto turn = [&](const OccupancyGrid&, int count) {
    return about_the_middle(count + 1, 1e-3 * (count + 1));
  };
  const int turns = replaced_in_a_row(about_the_middle(0, 0), turn);
  EXPECT_TRUE(turns > 10 && turns < 20) << turns << ": a corner moved by half a cell in all";
  const auto jitter = [&](const OccupancyGrid&, int count) {
    return about_the_middle(count, 1e-9 * (count % 2));
  };
  EXPECT_EQ(replaced_in_a_row(about_the_middle(0, 0), jitter), 1000);
}

TEST(GridBounds, LetACorrectedGridReplaceTheOneBefore) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> within{-1, 1};
  const auto drift = [&](const OccupancyGrid&, int) {
    return turned(with_z(grid(-7 + 0.009 * within(random), 5 + 0.009 * within(random), 300, 200),
                         0.001 * within(random)),
                  0.3 + 1e-9 * within(random));
  };
  EXPECT_EQ(replaced_in_a_row(drift({}, 0), drift), 1000);
}

TEST(GridBounds, TellIfTheyAreLargerThanTheGrid) {
  const auto newer = grid(0, 0, 40, 30);
  auto bounds = joint_bounds(GridBounds::from_grid(newer), GridBounds::from_grid(grid(0.05, 0.1, 20, 20)));
  EXPECT_FALSE(bounds.is_larger_than(newer)) << "on one lattice";
  for (const auto& older : {grid(-0.01, 0, 20, 20), grid(0, 0.015, 40, 30), with_z(newer, 0.001)}) {
    bounds = joint_bounds(GridBounds::from_grid(newer), GridBounds::from_grid(older));
    EXPECT_TRUE(bounds.is_larger_than(newer));
  }
}

Point corner_of(const OccupancyGrid& grid, bool right, bool top) {
  return Placement{grid.origin}(
      {right ? grid.width * grid.resolution : 0, top ? grid.height * grid.resolution : 0, 0});
}

/// Whether a point of "darpa" lies in `grid`, to half a cell. By the corners of the grid, in the plane.
bool is_in(const OccupancyGrid& grid, const Point& point) {
  const Point o = corner_of(grid, false, false), x = corner_of(grid, true, false),
              y = corner_of(grid, false, true);
  const auto along = [&](const Point& to) {
    const double length = std::hypot(to.x - o.x, to.y - o.y);
    const double at = ((point.x - o.x) * (to.x - o.x) + (point.y - o.y) * (to.y - o.y)) / length;
    return at > -0.51 * grid.resolution && at < length + 0.51 * grid.resolution;
  };
  return along(x) && along(y) && std::abs(point.z - o.z) < 0.51 * grid.resolution;
}

/// Whatever the way there, the last grid has all that was replaced.
TEST(GridBounds, LieWithinTheLastGridOfEachRow) {
  std::mt19937_64 random{2};
  const auto about = [&](double spread) {
    return std::uniform_real_distribution<double>{-spread, spread}(random);
  };
  int replaced = 0;
  for (int row = 0; row < 2000; ++row) {
    const double angle = about(std::numbers::pi);
    OccupancyGrid last = turned(grid(about(9), about(9), 40, 30), angle);
    auto bounds = GridBounds::from_grid(last);
    std::vector<OccupancyGrid> all{last};
    for (int i = 0; i < 30; ++i) {
      OccupancyGrid next = last;
      next.origin.position.x += about(0.02);
      next.origin.position.y += about(0.02);
      next.origin.position.z += about(0.005);
      next = turned(next, angle + about(0.003));
      if (!covers(next, bounds)) break;
      bounds = joint_bounds(GridBounds::from_grid(next), bounds);
      all.push_back(next);
      last = next;
      ++replaced;
    }
    for (const OccupancyGrid& each : all) {
      for (const bool right : {false, true}) {
        for (const bool top : {false, true}) ASSERT_TRUE(is_in(last, corner_of(each, right, top))) << row;
      }
    }
  }
  EXPECT_GT(replaced, 1000);
}

}  // namespace
}  // namespace adit::icd
