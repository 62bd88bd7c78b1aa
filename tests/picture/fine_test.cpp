#include "picture/fine.hpp"

#include <random>

#include "picture/maps.hpp"

namespace adit::picture {
namespace {

constexpr double kTwentieth = 0.05;

/// Maps drawn and stored as by MapPicture, and their finer tiles.
class FineLevels : public testing::Test {
 protected:
  void forward(const icd::MapUpdate& map) {
    easel.draw(map);
    grids.add(forwarded_grid(map), ++number);
  }
  Tile tile(const TileIndex& at) {
    const TileIndex over = coarser(at);
    if (over != drawn_over_ || drawn_number_ != number) {
      TileIndex base = at;
      while (base.level < 0) base = coarser(base);
      drawn_over_ = over, drawn_number_ = number;
      drawn_ = draw_fine_from_base(at, grids.grids_in(easel.layer, area_of(over)),
                                   easel.mosaic.tile(easel.layer, base, {}).tile);
    }
    return drawn_[place_in_block(at)];
  }
  /// The index of a pixel of a finer level; -1: no finer tile.
  int pixel(int level, int x, int y) {
    const TileIndex at{level, x >> 8, y >> 8};
    if (at != looked_at_ || looked_number_ != number) {
      looked_at_ = at, looked_number_ = number;
      looked_ = tile(at);
      if (looked_) packer_.unpack(*looked_, pixels_);
    }
    return looked_ ? pixels_[index_of(x & 255, y & 255)] : -1;
  }
  int seen(double x, double y, int level = -1) {
    const double scale = metres_per_pixel(level);
    return pixel(level, static_cast<int>(std::floor(x / scale)), static_cast<int>(std::floor(y / scale)));
  }

  Easel easel;
  ForwardedGrids grids;
  std::uint64_t number = 0;

 private:
  Packer packer_;
  FineBlock drawn_;  // the last one
  TileIndex drawn_over_{1, 0, 0}, looked_at_{1, 0, 0};
  std::uint64_t drawn_number_ = 0, looked_number_ = 0;
  Tile looked_;
  Pixels pixels_{};
};

TEST_F(FineLevels, EachFiveCentimetreCellIsAPixel) {
  std::mt19937_64 random{21};
  constexpr int kWidth = 700;
  Cells cells(std::size_t{kWidth} * kWidth);
  for (auto& cell : cells) cell = random() % 3 == 0 ? kUnknown : static_cast<std::uint8_t>(random() % 101);
  forward(gzipped(grid_at(3.35, 2.6, kWidth, kTwentieth, cells)));
  // An unknown base pixel is blank in the mosaic too: no cell fills it.
  for (int y = 0; y < kWidth; y += 7) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint8_t cell = cells[static_cast<std::size_t>(y * kWidth + x)];
      ASSERT_EQ(pixel(-1, x + 67, y + 52), cell == kUnknown ? 0 : cell + 1) << x << ", " << y;
    }
  }
}

TEST_F(FineLevels, WallOfOneCellIsOneCellThick) {
  Cells cells(200 * 200, 0);
  for (std::size_t x = 0; x < 200; ++x) cells[100 * 200 + x] = 100;
  forward(grid_at(0, 0, 200, kTwentieth, cells));
  EXPECT_EQ(easel.seen(1, 5.2), kOccupied) << "as coarse as the base";
  EXPECT_EQ(seen(1, 5.02), kOccupied);
  EXPECT_EQ(seen(1, 5.07), kFree);
  EXPECT_EQ(seen(1, 4.97), kFree);
}

TEST_F(FineLevels, CellsLargerThanPixelsAreWhole) {
  Cells cells(50 * 50, 0);
  cells[10 * 50 + 20] = 100;
  forward(grid_at(0, 0, 50, 0.2, cells));
  for (double y = 1.925; y < 2.3; y += 0.05) {
    for (double x = 3.925; x < 4.3; x += 0.05) {
      const bool inside = x > 4 && x < 4.2 && y > 2 && y < 2.2;
      ASSERT_EQ(seen(x, y), inside ? kOccupied : kFree) << x << ", " << y;
    }
  }
}

TEST_F(FineLevels, FinestLevelHasOneCentimetreCells) {
  Cells cells(500 * 500, 0);
  cells[200 * 500 + 100] = 100;
  forward(grid_at(0, 0, 500, 0.01, cells));
  EXPECT_EQ(seen(1.005, 2.005, -2), kOccupied);
  EXPECT_EQ(seen(1.015, 2.005, -2), kFree);
  EXPECT_EQ(seen(0.995, 2.005, -2), kFree);
  EXPECT_EQ(seen(1.03, 2.03, -1), kOccupied) << "the most occupied of a pixel";
}

TEST_F(FineLevels, TurnedGridIsDrawnWithoutGaps) {
  forward(grid_of(200, 0.1, {{5, 5, 0}, turned_by(0.5)}, Cells(200 * 200, 0)));
  for (double along = 0.2; along < 19.8; along += 0.05) {
    const double x = 5 + along * std::cos(0.5) - 10 * std::sin(0.5),
                 y = 5 + along * std::sin(0.5) + 10 * std::cos(0.5);
    ASSERT_EQ(seen(x, y), kFree) << along;
  }
}

TEST_F(FineLevels, LaterGridReplacesItsKnownCells) {
  forward(grid_at(0, 0, 100, kTwentieth, Cells(100 * 100, 100)));
  Cells part(40 * 40, 0);
  part[0] = kUnknown;
  forward(grid_at(2, 2, 40, kTwentieth, part));
  EXPECT_EQ(seen(3, 3), kFree);
  EXPECT_EQ(seen(2.025, 2.025), kOccupied) << "unknown cells keep the older value";
  EXPECT_EQ(seen(1, 1), kOccupied);
}

TEST_F(FineLevels, DiscardedGridsAreDrawnCoarsely) {
  forward(grid_at(0, 0, 100, kTwentieth, Cells(100 * 100, 100)));
  grids.clear();
  Cells part(100 * 100, kUnknown);
  part[0] = 0;
  forward(grid_at(0, 0, 100, kTwentieth, part));
  EXPECT_EQ(seen(0.025, 0.025), kFree);
  EXPECT_EQ(seen(0.225, 0.225), 0) << "a finer value is known for that base pixel";
  EXPECT_EQ(seen(0.275, 0.275), kOccupied);
  EXPECT_EQ(seen(4.975, 4.975), kOccupied);
}

TEST_F(FineLevels, NoTilesOutsideGrids) {
  forward(grid_at(0, 0, 100, kTwentieth, Cells(100 * 100, 0)));
  EXPECT_NE(tile({-1, 0, 0}), nullptr);
  EXPECT_EQ(tile({-1, 1, 0}), nullptr);
  EXPECT_EQ(tile({-1, -1, -1}), nullptr);
  EXPECT_EQ(tile({-2, 4, 4}), nullptr);
}

TEST_F(FineLevels, HasAllCellsOfTheBase) {
  std::mt19937_64 random{22};
  const auto any = [&](int low, int high) { return std::uniform_int_distribution{low, high}(random); };
  for (int round = 0; round < 6; ++round) {
    if (round == 3) grids.clear();  // from here on only the base knows some pixels
    const int side = any(1, 90);
    Cells cells(static_cast<std::size_t>(side * side));
    for (auto& cell : cells) cell = any(0, 2) == 0 ? kUnknown : static_cast<std::uint8_t>(any(0, 1) * 100);
    forward(grid_at(any(0, 20), any(0, 20), static_cast<std::uint32_t>(side), 0.05 * any(1, 4), cells));
    // If the base knows a pixel, the finer level does too.
    for (int i = 0; i < 150; ++i) {
      const int x = any(0, 159), y = any(0, 159);
      int highest = -1;
      for (int dot = 0; dot < 25; ++dot) {
        highest = std::max(highest, pixel(-1, x * 5 + dot % 5, y * 5 + dot / 5));
      }
      if (highest >= 0 && easel.pixel(0, x, y) > 0) {
        ASSERT_GT(highest, 0) << round << " at " << x << ", " << y;
      }
    }
  }
}

TEST_F(FineLevels, UnreadableGridIsSkipped) {
  const auto sound = forwarded_grid(grid_at(0, 0, 100, kTwentieth, Cells(100 * 100, 0)));
  ForwardedGrid damaged = *forwarded_grid(grid_at(0, 0, 100, kTwentieth, Cells(100 * 100, 100)));
  damaged.data.bytes = icd::ChunkedBytes{Cells{1, 2, 3}};
  const std::vector both{sound, std::make_shared<const ForwardedGrid>(damaged)};
  Pixels pixels{};
  Packer{}.unpack(*draw_fine({0, 0, 0}, both, nullptr)[0], pixels);
  EXPECT_EQ(pixels[index_of(50, 50)], kFree);
}

TEST_F(FineLevels, HostileGridsEndInTime) {
  const Cells cells(10'000, 0);
  for (const double resolution : {1e-300, 1e-9, 1e-3, 0.2, 0.5}) {
    for (const double x : {0.0, -8191.9, 1e9, 1e300}) {
      for (const double yaw : {0.0, 0.3}) {
        const std::vector one{
            forwarded_grid(grid_of(100, resolution, {{x, -x / 2, x}, turned_by(yaw)}, cells))};
        for (const TileIndex& at : {TileIndex{-1, 0, 0}, TileIndex{-2, 0, 0}, TileIndex{-2, -3200, 3199}}) {
          draw_fine_from_base(at, one, nullptr);
        }
      }
    }
  }
}

TEST(TilesOfFinerLevels, LieInTilesOfTheNextCoarserLevel) {
  EXPECT_EQ(coarser({-1, 4, -1}), (TileIndex{0, 0, -1}));
  EXPECT_EQ(coarser({-1, 5, -5}), (TileIndex{0, 1, -1}));
  EXPECT_EQ(coarser({-2, -6, 0}), (TileIndex{-1, -2, 0}));
  EXPECT_EQ(place_in_block({-1, 0, -1}), 20U);
  EXPECT_EQ(place_in_block({-2, -6, 0}), 4U);
  EXPECT_TRUE(is_in_world({-1, 639, -640}));
  EXPECT_FALSE(is_in_world({-1, 640, 0}));
  EXPECT_FALSE(is_in_world({-3, 0, 0}));
  EXPECT_FALSE(is_in_world({-2, 2147483647, 0}));
}

}  // namespace
}  // namespace adit::picture
