#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "picture/draw.hpp"
#include "picture/maps.hpp"

namespace adit::picture {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();

std::size_t base_tiles(const Drawing& drawing) {
  std::size_t count = 0;
  for (const auto& [at, tile] : drawing.tiles) count += at.level == 0 ? 1 : 0;
  return count;
}

TEST(HostileGrid, OfAnySizeAndPlaceIsLimitedInTiles) {
  const Cells cells(10'000, 0);
  for (const double resolution : {kSmallest, 1e-300, 1e-9, 1e-3, 1.0, 1e3, 1e9, 1e300, kLargest}) {
    for (const double x : {0.0, -8191.9, 1e9, kLargest, -kLargest}) {
      for (const double yaw : {0.0, 0.3}) {
        const auto map = grid_of(100, resolution, {{x, -x / 2, x}, turned_by(yaw)}, cells);
        const auto drawing = draw(map, {});
        ASSERT_TRUE(drawing);
        EXPECT_LE(base_tiles(*drawing), Sheet::kMostTiles);
        EXPECT_LE(drawing->left_out, kMostDabs + 2 * kWorldPixels + cells.size())
            << "otherwise drawing takes too long";
        if (drawing->area) {
          EXPECT_GE(drawing->area->left, -kWorldMetres);
          EXPECT_LE(drawing->area->top, kWorldMetres);
        } else {
          EXPECT_GT(drawing->left_out, 0U) << resolution << " at " << x << " turned by " << yaw;
        }
      }
    }
  }
}

TEST(HostileGrid, FarOutsideIsOmittedAndCounted) {
  EXPECT_EQ(draw(grid_at(1e9, 0, 10, 0.1, Cells(100, 0)), {})->left_out, 100U);
  EXPECT_EQ(draw(grid_at(0, -1e9, 10, 0.1, Cells(100, 100)), {})->left_out, 100U);
  EXPECT_EQ(draw(grid_at(1e9, 0, 10, 0.1, Cells(100, kUnknown)), {})->left_out, 0U)
      << "the grid has only unknown cells";
  const auto half = draw(grid_at(8190, 0, 40, 0.1, Cells(40, 0)), {});
  EXPECT_EQ(half->left_out, 20U);
  EXPECT_EQ(half->area, (Area{8190, 0, 8192, 0.25}));
}

TEST(HostileGrid, UprightIsALine) {
  const auto drawing = draw(grid_of(40, 0.25, {{0, 0, 0}, {1, 0, 0, 1}}, Cells(1600, 0)), {});
  ASSERT_TRUE(drawing && drawing->area);
  EXPECT_LE(drawing->area->top - drawing->area->bottom, 0.5);
}

TEST(HostileGrid, WithMillionsOfColumnsIsNotDrawn) {
  const Cells cells(kMostColumns + 1, 0);
  const auto map = grid_at(0, 0, static_cast<std::uint32_t>(cells.size()), 1e-3, cells);
  EXPECT_EQ(draw(map, {})->left_out, cells.size());
}

TEST(HostileGrid, WithAWrongCountOfCellsIsHarmless) {
  auto more = grid_at(0, 0, 4, 0.25, Cells(16, 0));
  std::get<icd::OccupancyGrid>(more.msg).height = 2;
  EXPECT_EQ(draw(more, {})->area, (Area{0, 0, 1, 0.5}));
  auto fewer = grid_at(0, 0, 4, 0.25, Cells(16, 0));
  std::get<icd::OccupancyGrid>(fewer.msg).height = 400;
  EXPECT_EQ(draw(fewer, {})->area, (Area{0, 0, 1, 1}));
}

TEST(HostileGrid, TurnedWithHugeCellsIsLimitedInPixels) {
  const auto map = grid_of(1000, 15, {{-7500, -7500, 0}, turned_by(0.1)}, Cells(1'000'000, 0));
  const auto drawing = draw(map, {});
  EXPECT_LE(base_tiles(*drawing), Sheet::kMostTiles);
  EXPECT_GT(drawing->left_out, 0U);
}

TEST(HostileCloud, AcrossTheWorldIsLimitedInTiles) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> anywhere{-kWorldMetres, kWorldMetres};
  std::vector<icd::Point> points;
  for (int i = 0; i < 20'000; ++i) points.push_back({anywhere(random), anywhere(random), 0});
  const auto drawing = draw(cloud_of(points), {});
  EXPECT_EQ(base_tiles(*drawing), Sheet::kMostTiles);
  EXPECT_GT(drawing->left_out, 19'000U);
}

TEST(HostileCloud, WithAHugeOriginIsOmitted) {
  for (const double far : {1e30, kLargest, -kLargest}) {
    const auto map =
        cloud_of({{far, far, far}, {1, 1, 1}}, icd::Pose{{far, far, far}, {1e-300, 1e300, 1, 1e300}});
    const auto drawing = draw(map, {});
    ASSERT_TRUE(drawing);
    EXPECT_EQ(drawing->left_out, 2U);
    EXPECT_TRUE(drawing->tiles.empty());
  }
}

TEST(HostileData, OfAnotherFormatIsAnError) {
  for (const std::size_t cut : {std::size_t{0}, std::size_t{5}, std::size_t{20}}) {
    auto map = gzipped(grid_at(0, 0, 100, 0.25, Cells(10'000, 0)));
    auto bytes = map.data.bytes.to_vector();
    bytes.resize(cut);
    map.data.bytes = icd::ChunkedBytes{bytes};
    const auto drawing = draw(map, {});
    ASSERT_FALSE(drawing) << cut;
    EXPECT_THAT(drawing.error().sentence, testing::StartsWith("msg.data: expected a gzip member"));
  }
}

TEST(HostileData, LargerThanDeclaredIsAnError) {
  auto map = gzipped(grid_at(0, 0, 100, 0.25, Cells(1'000'000, 0)));
  map.data.raw_size = 10'000;
  EXPECT_FALSE(draw(map, {}));
}

}  // namespace
}  // namespace adit::picture
