#include <random>

#include "picture/maps.hpp"

namespace adit::picture {
namespace {

/// A pixel of a coarser level is the highest of its sixteen pixels.
class Levels : public testing::Test {
 protected:
  /// All non-zero pixels of a layer's level.
  std::map<std::pair<int, int>, int> known(int level) {
    std::map<std::pair<int, int>, int> pixels;
    for (const LayerView& layer : easel.mosaic.layers()) {
      if (layer.layer != easel.layer) continue;
      for (const TileView& tile : layer.tiles) {
        if (tile.at.level != level) continue;
        const Pixels these = easel.pixels(tile.at);
        for (int y = 0; y < kSide; ++y) {
          for (int x = 0; x < kSide; ++x) {
            const int index = these[index_of(x, y)];
            if (index != 0) pixels[{tile.at.x * kSide + x, tile.at.y * kSide + y}] = index;
          }
        }
      }
    }
    return pixels;
  }

  void expect_that_they_agree() {
    for (int level = 1; level < kLevels; ++level) {
      std::map<std::pair<int, int>, int> coarse;
      for (const auto& [at, index] : known(level - 1)) {
        int& highest = coarse[{at.first >> 2, at.second >> 2}];
        highest = std::max(highest, index);
      }
      EXPECT_FALSE(coarse.empty());
      ASSERT_EQ(known(level), coarse) << "level " << level;
    }
  }

  Easel easel;
};

TEST_F(Levels, AgreeWithTheBaseAfterPartialGrids) {
  std::mt19937_64 random{11};
  const auto any = [&](int low, int high) { return std::uniform_int_distribution{low, high}(random); };
  for (int round = 0; round < 5; ++round) {
    const int side = any(1, 90);
    Cells cells(static_cast<std::size_t>(side * side));
    for (auto& cell : cells) cell = any(0, 2) == 0 ? kUnknown : static_cast<std::uint8_t>(any(0, 1) * 100);
    easel.draw(grid_of(static_cast<std::uint32_t>(side), 0.5,
                       {{any(-150, 150) * 1.0, any(-150, 150) * 1.0, 0}, turned_by(round % 3 * 0.4)}, cells));
    expect_that_they_agree();
  }
}

TEST_F(Levels, AgreeWithTheBaseAfterClouds) {
  std::mt19937_64 random{12};
  std::normal_distribution<double> metres{0, 70};
  for (int round = 0; round < 2; ++round) {
    std::vector<icd::Point> points;
    for (int i = 0; i < 3000; ++i) points.push_back({metres(random), metres(random), metres(random) / 10});
    easel.draw(cloud_of(points));
    expect_that_they_agree();
  }
}

TEST_F(Levels, ClearedCellsAreClearedAtEach) {
  easel.draw(grid_at(0, 0, 4, 0.25, Cells(16, 100)));
  easel.draw(grid_at(0, 0, 4, 0.25, Cells(16, 0)));
  for (int level = 0; level < kLevels; ++level) EXPECT_EQ(easel.seen(0.5, 0.5, level), kFree) << level;
}

TEST_F(Levels, AreRightWestAndSouthOfTheOrigin) {
  easel.draw(grid_at(-300.25, -5.25, 1, 0.25, {100}));
  for (int level = 0; level < kLevels; ++level) {
    EXPECT_EQ(easel.seen(-300.2, -5.2, level), kOccupied) << level;
  }
  EXPECT_EQ(easel.pixels({2, -1, -1})[index_of(180, 254)], kOccupied) << "-301 m is pixel -76, -5.25 m is -2";
}

}  // namespace
}  // namespace adit::picture
