#include "queues/lattice.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "queues/maps.hpp"

namespace adit::queues {
namespace {

icd::Quaternion yaw(double angle) {
  return {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
}

/// `older` moved by cells along its own axes.
icd::OccupancyGrid shifted(icd::OccupancyGrid older, double angle, double cells_x, double cells_y) {
  const double x = cells_x * older.resolution, y = cells_y * older.resolution;
  older.origin.orientation = yaw(angle);
  older.origin.position.x += std::cos(angle) * x - std::sin(angle) * y;
  older.origin.position.y += std::sin(angle) * x + std::cos(angle) * y;
  return older;
}

icd::OccupancyGrid with_z(icd::OccupancyGrid grid, double z) {
  grid.origin.position.z = z;
  return grid;
}

icd::OccupancyGrid turned(icd::OccupancyGrid grid, double angle) {
  grid.origin.orientation = yaw(angle);
  return grid;
}

/// Whether the cells of `inner` are cells of `outer`.
bool holds(const icd::OccupancyGrid& outer, const icd::OccupancyGrid& inner) {
  const auto cells = cells_in(outer, inner);
  return cells && Cells{0, 0, outer.width, outer.height}.holds(*cells);
}

struct LatticeCase {
  const char* what;
  icd::OccupancyGrid of, grid;
  std::optional<Cells> cells;
};

TEST(Lattice, HasTheResultsOfTheTable) {
  const double far = 1e300;
  const Cells moved{20, 20, 40, 30};
  const LatticeCase cases[] = {
      {"the same", grid(-5, 3, 40, 30), grid(-5, 3, 40, 30), Cells{0, 0, 40, 30}},
      {"a whole number of cells off", grid(-1, -1, 80, 80), grid(0, 0, 40, 30), moved},
      {"to the other side", grid(0, 0, 80, 80), grid(-1, 0.05, 40, 30), Cells{-20, 1, 40, 30}},
      {"half a cell off", grid(-1.025, -1, 80, 80), grid(0, 0, 40, 30), {}},
      {"a hundredth of a cell off", grid(-1.0005, -1, 80, 80), grid(0, 0, 40, 30), {}},
      {"a millionth of a cell off", grid(-1 - 5e-8, -1 + 5e-8, 80, 80), grid(0, 0, 40, 30), moved},
      {"finer", grid(0, 0, 400, 400, 0.025), grid(0, 0, 40, 30), {}},
      {"another height", with_z(grid(-1, -1, 80, 80), 0.5), grid(0, 0, 40, 30), {}},
      {"the same height", with_z(grid(-1, -1, 80, 80), 0.5), with_z(grid(0, 0, 40, 30), 0.5), moved},
      {"another orientation", turned(grid(-1, -1, 80, 80), 0.01), grid(0, 0, 40, 30), {}},
      {"so far out that cells cannot be told apart, alike", grid(far, 0, 80, 80), grid(far, 0, 40, 30),
       Cells{0, 0, 40, 30}},
      {"so far out, elsewhere", grid(far, 0, 80, 80), grid(far * 2, 0, 40, 30), {}},
      {"far out and near", grid(0, 0, 80, 80), grid(far, 0, 40, 30), {}},
      {"a resolution that overflows", grid(1, 1, 2, 2, 5e-324), grid(1, 1, 1, 1, 5e-324), Cells{0, 0, 1, 1}},
  };
  for (const auto& [what, of, grid, cells] : cases) EXPECT_EQ(cells_in(of, grid), cells) << what;
}

TEST(Lattice, AcceptsAResolutionRoundedToFloat32) {
  const double resolution = static_cast<double>(0.05F);  // 0.05000000074505806
  for (int cells = 1; cells < 4000; cells += 7) {
    const auto older = grid(-10, -10, 100, 100, resolution);
    const auto newer = grid(-10 - cells * 0.05, -10, 8192, 100, resolution);
    EXPECT_TRUE(holds(newer, older)) << cells << " cells apart";
  }
}

TEST(Lattice, MeasuresAlongTheAxesOfTurnedGrids) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> angle{-std::numbers::pi, std::numbers::pi}, metres{-200, 200};
  std::uniform_int_distribution<int> cells{-50, 50};
  for (int i = 0; i < 2000; ++i) {
    auto newer = grid(metres(random), metres(random), 60, 40, 0.1);
    const double turn = angle(random);
    newer = turned(newer, turn);
    const int x = cells(random), y = cells(random);
    auto older = shifted(newer, turn, x, y);
    older.width = 20;
    older.height = 10;
    const bool inside = x >= 0 && y >= 0 && x + 20 <= 60 && y + 10 <= 40;
    EXPECT_EQ(holds(newer, older), inside) << x << ", " << y << " turned by " << turn;
    EXPECT_FALSE(holds(newer, shifted(newer, turn, x + 0.5, y)));
  }
}

/// A random grid with few values of each kind, so that equalities are frequent.
icd::OccupancyGrid any_grid(std::mt19937_64& random) {
  const auto one_of = [&](std::initializer_list<double> values) {
    return values.begin()[std::uniform_int_distribution<std::size_t>{0, values.size() - 1}(random)];
  };
  auto any = grid(one_of({0, 0.1, -0.1, -0.3, 0.0999, 1e-5, 1e290}), one_of({0, 0.1, -0.2, 0.00004, 0.00006}),
                  static_cast<std::uint32_t>(one_of({1, 2, 4, 7})),
                  static_cast<std::uint32_t>(one_of({1, 3, 6})), one_of({0.1, 0.1, 0.1, 0.05}));
  any.origin.position.z = one_of({0, 0, 0, 0.00004, 0.2});
  any.origin.orientation = yaw(one_of({0, 0, 0, 1}));
  return any;
}

TEST(Lattice, HoldsItsOwnCells) {
  std::mt19937_64 random{2};
  for (int i = 0; i < 1000; ++i) {
    const auto any = any_grid(random);
    EXPECT_TRUE(holds(any, any));
  }
}

TEST(Lattice, IsTransitive) {
  std::mt19937_64 random{3};
  int chains = 0;
  for (int i = 0; i < 40'000; ++i) {
    const auto a = any_grid(random), b = any_grid(random);
    for (int left = holds(a, b) ? 50 : 0; left > 0; --left) {
      const auto c = any_grid(random);
      if (!holds(b, c)) continue;
      ++chains;
      ASSERT_TRUE(holds(a, c));
    }
  }
  EXPECT_GT(chains, 30);
}

/// The centre of a cell in "darpa" (ICD 6.3.1): origin, then row by row along the grid's axes.
icd::Point middle_of(const icd::OccupancyGrid& grid, double column, double row) {
  const double angle = 2 * std::atan2(grid.origin.orientation.z, grid.origin.orientation.w);
  const double x = (column + 0.5) * grid.resolution, y = (row + 0.5) * grid.resolution;
  return {grid.origin.position.x + std::cos(angle) * x - std::sin(angle) * y,
          grid.origin.position.y + std::sin(angle) * x + std::cos(angle) * y, grid.origin.position.z};
}

/// Whether a cell of `grid` has its centre at that point, within a thousandth of a cell.
bool has_cell_at(const icd::OccupancyGrid& grid, const icd::Point& point) {
  const double close = grid.resolution * 0.002;
  for (std::uint32_t row = 0; row < grid.height; ++row) {
    for (std::uint32_t column = 0; column < grid.width; ++column) {
      const auto middle = middle_of(grid, column, row);
      if (std::hypot(middle.x - point.x, middle.y - point.y, middle.z - point.z) < close) return true;
    }
  }
  return false;
}

TEST(Lattice, HoldsNoCellThatLiesOutside) {
  std::mt19937_64 random{4};
  int held = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto newer = any_grid(random), older = any_grid(random);
    if (!holds(newer, older)) continue;
    ++held;
    for (const double row : {0.0, older.height - 1.0}) {
      for (const double column : {0.0, older.width - 1.0}) {
        ASSERT_TRUE(has_cell_at(newer, middle_of(older, column, row)));
      }
    }
  }
  EXPECT_GT(held, 100);
}

}  // namespace
}  // namespace adit::queues
