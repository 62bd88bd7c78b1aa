#include <random>

#include "picture/maps.hpp"

namespace adit::picture {
namespace {

TEST(Grid, DrawsEachCellInItsPlace) {
  Easel easel;
  easel.draw(grid_at(10, -4, 3, 0.25, {0, 50, 100, kUnknown, 7, kUnknown}));
  EXPECT_EQ(easel.seen(10.1, -3.9), kFree);
  EXPECT_EQ(easel.seen(10.3, -3.9), 51);
  EXPECT_EQ(easel.seen(10.6, -3.9), kOccupied);
  EXPECT_EQ(easel.seen(10.1, -3.7), 0) << "unknown";
  EXPECT_EQ(easel.seen(10.3, -3.7), 8);
  EXPECT_EQ(easel.seen(9.9, -3.9), 0) << "outside";
}

TEST(Grid, TopRowIsTheFirstOfThePicture) {
  Easel easel;
  easel.draw(grid_at(0, 0, 1, 0.25, {100, 0}));
  const Pixels pixels = easel.pixels({0, 0, 0});
  EXPECT_EQ(pixels[255 * 256], kOccupied) << "the lower left corner";
  EXPECT_EQ(pixels[254 * 256], kFree);
}

TEST(Grid, OccupiedHidesFreeAndFreeHidesUnknown) {
  Easel easel;
  Cells cells(25, kUnknown);  // one pixel of 5 x 5 cells
  cells[3] = 0;
  easel.draw(grid_at(0, 0, 5, 0.05, cells));
  EXPECT_EQ(easel.seen(0.1, 0.1), kFree);
  cells[12] = 100;
  easel.draw(grid_at(0, 0, 5, 0.05, cells));
  EXPECT_EQ(easel.seen(0.1, 0.1), kOccupied);
}

TEST(Grid, KnownCellsReplaceEarlierOnes) {
  Easel easel;
  easel.draw(grid_at(0, 0, 3, 0.25, {100, 100, 0}));
  easel.draw(grid_at(0, 0, 3, 0.25, {kUnknown, 0, 100}));
  EXPECT_EQ(easel.seen(0.1, 0.1), kOccupied);
  EXPECT_EQ(easel.seen(0.3, 0.1), kFree);
  EXPECT_EQ(easel.seen(0.6, 0.1), kOccupied);
}

TEST(Grid, ValuesOutsideTheIcdAreUnknown) {
  Easel easel;
  easel.draw(grid_at(0, 0, 3, 0.25, {101, 254, 0}));
  EXPECT_EQ(easel.seen(0.1, 0.1), 0);
  EXPECT_EQ(easel.seen(0.3, 0.1), 0);
  EXPECT_EQ(easel.seen(0.6, 0.1), kFree);
}

TEST(Grid, TellsItsAreaToAPixel) {
  Easel easel;
  Cells cells(100, kUnknown);
  cells[23] = 0, cells[57] = 100;  // columns 3 to 7, rows 2 to 5
  const auto drawing = easel.draw(grid_at(-70, -1, 10, 0.25, cells));
  EXPECT_EQ(drawing.area, (Area{-69.25, -0.5, -68, 0.5}));
  EXPECT_EQ(drawing.heights, std::nullopt);
  EXPECT_EQ(easel.draw(grid_at(0, 0, 1, 0.25, {kUnknown})).area, std::nullopt);
}

TEST(Grid, RepeatedGridChangesNoTile) {
  Easel easel;
  const auto map = grid_at(-3, 7, 40, 0.1, Cells(4000, 100));
  EXPECT_FALSE(easel.draw(map).tiles.empty());
  EXPECT_TRUE(easel.draw(map).tiles.empty());
}

TEST(Grid, GrowingGridDoesNotFlicker) {  // 0.1 m: centres lie on the borders of pixels of 0.25 m
  Easel easel;
  const auto wall = [](int more) {  // the same wall at x = 5 in a grid that begins `more` cells further left
    Cells cells;
    const int width = 100 + more;
    for (int i = 0; i < 20 * width; ++i) cells.push_back(i % width == 50 + more ? 100 : 0);
    // The origin as a sender computes it: a float32 of a sum.
    return grid_at(static_cast<double>(static_cast<float>(-more * 0.1)), 0, static_cast<std::uint32_t>(width),
                   0.1, cells);
  };
  easel.draw(wall(0));
  for (int more = 1; more < 60; ++more) {
    easel.draw(wall(more));
    for (double x = 0.125; x < 10; x += 0.25) {
      EXPECT_EQ(easel.seen(x, 1) == kOccupied, std::floor(x / 0.25) == std::floor(5.05 / 0.25))
          << more << ' ' << x;
    }
  }
}

/// The expected pixel, directly from the rule.
std::uint8_t expected(const icd::OccupancyGrid& grid, const Cells& cells, int px, int py) {
  const auto shown = [](double origin, double resolution, std::uint32_t count, int pixel) {
    std::vector<std::uint32_t> those;
    for (std::uint32_t cell = 0; cell < count; ++cell) {
      if (std::floor((origin + (cell + 0.5) * resolution) / 0.25) == pixel) those.push_back(cell);
    }
    const double own = std::floor(((pixel + 0.5) * 0.25 - origin) / resolution);
    if (those.empty() && own >= 0 && own < count) those.push_back(static_cast<std::uint32_t>(own));
    return those;
  };
  std::uint8_t highest = 0;
  for (const auto row : shown(grid.origin.position.y, grid.resolution, grid.height, py)) {
    for (const auto column : shown(grid.origin.position.x, grid.resolution, grid.width, px)) {
      const std::uint8_t value = cells[row * grid.width + column];
      if (value <= 100) highest = std::max<std::uint8_t>(highest, value + 1);
    }
  }
  return highest;
}

TEST(Grid, PixelsShowCellsCentredInThemOrAtTheirCentre) {
  std::mt19937_64 random{7};
  const auto any = [&](int low, int high) { return std::uniform_int_distribution{low, high}(random); };
  for (const double resolution : {0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5, 1.0}) {
    for (int round = 0; round < 6; ++round) {
      const int width = any(1, 60), height = any(1, 60);
      Cells cells(static_cast<std::size_t>(width * height));
      for (auto& cell : cells) cell = any(0, 3) == 0 ? static_cast<std::uint8_t>(any(0, 100)) : kUnknown;
      // Not on the pixels' borders, where rounding decides.
      const auto map = grid_at(any(-9000, 9000) * 0.01 + 0.0023, any(-9000, 9000) * 0.01 + 0.0023,
                               static_cast<std::uint32_t>(width), resolution, cells);
      const auto& grid = std::get<icd::OccupancyGrid>(map.msg);
      Easel easel;
      const auto drawing = easel.draw(round % 2 == 0 ? map : gzipped(map));
      EXPECT_EQ(drawing.left_out, 0U);
      const int left = static_cast<int>(std::floor(grid.origin.position.x / 0.25)) - 2;
      const int bottom = static_cast<int>(std::floor(grid.origin.position.y / 0.25)) - 2;
      for (int y = bottom; y < bottom + height * resolution / 0.25 + 5; ++y) {
        for (int x = left; x < left + width * resolution / 0.25 + 5; ++x) {
          ASSERT_EQ(easel.pixel(0, x, y), expected(grid, cells, x, y)) << resolution << ": " << x << ' ' << y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace adit::picture
