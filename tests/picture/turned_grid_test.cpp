#include <numbers>
#include <random>

#include "picture/maps.hpp"

namespace adit::picture {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(TurnedGrid, QuarterTurnPutsItsRowsAlongMinusX) {
  Easel easel;
  easel.draw(grid_of(3, 0.25, {{20, 5, 0}, turned_by(kPi / 2)}, {100, 0, 20, kUnknown, 0, 40}));
  EXPECT_EQ(easel.seen(19.875, 5.125), kOccupied);
  EXPECT_EQ(easel.seen(19.875, 5.375), kFree);
  EXPECT_EQ(easel.seen(19.875, 5.625), 21);
  EXPECT_EQ(easel.seen(19.625, 5.625), 41);
  EXPECT_EQ(easel.seen(19.625, 5.125), 0);
}

TEST(TurnedGrid, HalfTurnPutsItBelowAndLeftOfItsOrigin) {
  Easel easel;
  easel.draw(grid_of(2, 0.25, {{0, 0, 0}, turned_by(kPi)}, {100, 0, 20, 40}));
  EXPECT_EQ(easel.seen(-0.125, -0.125), kOccupied);
  EXPECT_EQ(easel.seen(-0.375, -0.125), kFree);
  EXPECT_EQ(easel.seen(-0.125, -0.375), 21);
  EXPECT_EQ(easel.seen(-0.375, -0.375), 41);
}

/// A cell's place in the world; its lower left corner is (0, 0).
icd::Point place(const icd::OccupancyGrid& grid, double yaw, double column, double row) {
  const double x = column * grid.resolution, y = row * grid.resolution;
  return {grid.origin.position.x + x * std::cos(yaw) - y * std::sin(yaw),
          grid.origin.position.y + x * std::sin(yaw) + y * std::cos(yaw), 0};
}

TEST(TurnedGrid, ShowsEachKnownCellAndNothingElse) {
  std::mt19937_64 random{3};
  const auto any = [&](int low, int high) { return std::uniform_int_distribution{low, high}(random); };
  for (const double resolution : {0.03, 0.05, 0.1, 0.17, 0.2, 0.25, 0.4, 1.0}) {
    for (const double yaw : {0.3, -1.1, 2.5, kPi / 4, 3.0}) {
      const int side = any(5, 30);
      Cells cells(static_cast<std::size_t>(side * side), kUnknown);
      for (auto& cell : cells) {
        if (any(0, 5) == 0) cell = static_cast<std::uint8_t>(any(0, 100));
      }
      const auto map = grid_of(static_cast<std::uint32_t>(side), resolution,
                               {{any(-900, 900) * 0.1, any(-900, 900) * 0.1, 0}, turned_by(yaw)}, cells);
      const auto& grid = std::get<icd::OccupancyGrid>(map.msg);
      Easel easel;
      easel.draw(map);
      std::vector<icd::Point> known;
      for (int i = 0; i < side * side; ++i) {
        if (cells[static_cast<std::size_t>(i)] == kUnknown) continue;
        known.push_back(place(grid, yaw, i % side + 0.5, i / side + 0.5));
        ASSERT_GE(easel.seen(known.back().x, known.back().y), cells[static_cast<std::size_t>(i)] + 1)
            << resolution << " m, turned by " << yaw;
      }
      const double reach = (resolution + 0.25) / std::numbers::sqrt2 + 1e-9;  // of a cell and of a pixel
      const auto centre = place(grid, yaw, side / 2.0, side / 2.0);
      const double around = side * resolution + 1;
      for (double y = centre.y - around; y < centre.y + around; y += 0.25) {
        for (double x = centre.x - around; x < centre.x + around; x += 0.25) {
          if (easel.seen(x, y) == 0) continue;
          const double px = std::floor(x / 0.25) * 0.25 + 0.125, py = std::floor(y / 0.25) * 0.25 + 0.125;
          ASSERT_TRUE(std::ranges::any_of(
              known, [&](const icd::Point& p) { return std::hypot(p.x - px, p.y - py) <= reach; }))
              << resolution << " m, turned by " << yaw << " at " << x << ", " << y;
        }
      }
    }
  }
}

TEST(TurnedGrid, HasNoGapsForAnyCellSize) {
  for (const double resolution : {0.05, 0.17, 0.18, 0.25, 0.3, 0.7, 2.0, 9.0}) {
    for (const double yaw : {0.01, 0.5, kPi / 4, 1.2, -2.0}) {
      const auto side = static_cast<std::uint32_t>(std::ceil(20 / resolution));
      const auto map =
          grid_of(side, resolution, {{33, 34, 0}, turned_by(yaw)}, Cells(std::size_t{side} * side, 0));
      const auto& grid = std::get<icd::OccupancyGrid>(map.msg);
      Easel easel;
      easel.draw(map);
      const double step = 0.17 / resolution;  // small enough to hit each pixel
      for (double row = 0.3 / resolution; row < side - 0.3 / resolution; row += step) {
        for (double column = 0.3 / resolution; column < side - 0.3 / resolution; column += step) {
          const auto at = place(grid, yaw, column, row);
          ASSERT_EQ(easel.seen(at.x, at.y), kFree) << resolution << " m, turned by " << yaw;
        }
      }
    }
  }
}

}  // namespace
}  // namespace adit::picture
