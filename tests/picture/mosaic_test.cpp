#include "picture/mosaic.hpp"

#include <gmock/gmock.h>

#include <random>

#include "icd/sentence.hpp"
#include "picture/maps.hpp"

namespace adit::picture {
namespace {

icd::MapUpdate of(const char* robot, icd::MapUpdate map) {
  map.name = icd::RobotName::parse(robot);
  return map;
}

/// A square of 32 m with cells that compress badly: one tile of each level.
icd::MapUpdate noisy(unsigned seed, double x = 8) {
  std::mt19937 random{seed};
  Cells cells(std::size_t{128} * 128);
  for (auto& cell : cells) cell = static_cast<std::uint8_t>(random() % 101);
  return grid_at(x, 8, 128, 0.25, cells);
}

TEST(Mosaic, IsEmptyAtFirst) {
  const Mosaic mosaic;
  EXPECT_EQ(mosaic.version(), 0U);
  EXPECT_TRUE(mosaic.layers().empty());
  EXPECT_EQ(mosaic.tile({"a", LayerKind::Grid}, {0, 0, 0}, {}).tile, nullptr);
  EXPECT_TRUE(mosaic.canvas({"a", LayerKind::Grid}).tiles.empty());
}

TEST(Mosaic, HasALayerForEachRobotAndKind) {
  Easel easel;
  easel.draw(of("ugv1", grid_at(0, 0, 1, 0.25, {0})));
  easel.draw(of("ugv2", grid_at(5, 5, 1, 0.25, {100})));
  easel.draw(of("", cloud_of({{9, 9, 1}})));
  const auto layers = easel.mosaic.layers();
  ASSERT_EQ(layers.size(), 3U);
  EXPECT_EQ(layers[0].layer, (Layer{"", LayerKind::Cloud}));
  EXPECT_EQ(layers[1].layer, (Layer{"ugv1", LayerKind::Grid}));
  EXPECT_EQ(layers[1].bounds, (Area{0, 0, 0.25, 0.25}));
  EXPECT_EQ(layers[2].bounds, (Area{5, 5, 5.25, 5.25}));
  EXPECT_TRUE(layers[0].heights);
  EXPECT_FALSE(layers[1].heights);
  EXPECT_EQ(layers[1].tiles.size(), 3U) << "one of each level";
  easel.layer = {"ugv1", LayerKind::Grid};
  EXPECT_EQ(easel.seen(5.1, 5.1), 0) << "another robot's cells";
}

TEST(Mosaic, ShowsAnEarlierTime) {
  Easel easel;
  easel.draw(grid_at(0, 0, 1, 0.25, {100}));  // at 1001
  easel.draw(grid_at(0, 0, 1, 0.25, {0}));
  easel.draw(grid_at(0.25, 0, 1, 0.25, {100}));
  EXPECT_EQ(easel.seen(0.1, 0.1, 0, 1000.5), 0);
  EXPECT_EQ(easel.seen(0.1, 0.1, 0, 1001), kOccupied);
  EXPECT_EQ(easel.seen(0.1, 0.1, 0, 1002.5), kFree);
  EXPECT_EQ(easel.seen(0.3, 0.1, 0, 1002.5), 0);
  EXPECT_EQ(easel.seen(0.3, 0.1), kOccupied);
  EXPECT_FALSE(easel.mosaic.tile(easel.layer, {0, 0, 0}, 1002.5).newest);
  EXPECT_TRUE(easel.mosaic.tile(easel.layer, {0, 0, 0}, 1003).newest);
}

TEST(Mosaic, FollowsAClockStep) {
  for (const double step : {3e8, -3e8}) {
    Easel easel;
    easel.now = 1e9;
    easel.draw(grid_at(0, 0, 1, 0.25, {100}));
    easel.mosaic.wipe(easel.now + 1);
    easel.mosaic.move(step);
    easel.now += 1 + step;
    easel.draw(grid_at(0, 0, 1, 0.25, {0}));
    EXPECT_EQ(easel.seen(0.1, 0.1, 0, 1e9 + 1 + step), kOccupied)
        << "the earlier picture at the shifted time";
    EXPECT_EQ(easel.mosaic.tile(easel.layer, {0, 0, 0}, std::nullopt).stamp, easel.now)
        << "not at the old time";
    EXPECT_EQ(easel.mosaic.wipe_time(), 1e9 + 2 + step);
    EXPECT_EQ(easel.mosaic.layers().at(0).first, 1e9 + 1 + step);
    EXPECT_EQ(easel.mosaic.layers().at(0).last, easel.now);
  }
}

TEST(Mosaic, ListsTilesChangedSinceAVersion) {
  Easel easel;
  easel.draw(grid_at(0, 0, 1, 0.25, {100}));
  const auto before = easel.mosaic.version();
  easel.draw(grid_at(64, 0, 1, 0.25, {100}));
  const auto layers = easel.mosaic.layers(before);
  ASSERT_EQ(layers.size(), 1U);
  std::vector<TileIndex> changed;
  for (const TileView& tile : layers[0].tiles) changed.push_back(tile.at);
  EXPECT_THAT(changed, testing::ElementsAre(TileIndex{0, 1, 0}, TileIndex{1, 0, 0}, TileIndex{2, 0, 0}));
  EXPECT_EQ(layers[0].tiles[0].first, 1002);
  EXPECT_EQ(layers[0].tiles[1].first, 1001);
  EXPECT_EQ(layers[0].tiles[1].stamp, 1002);
  EXPECT_TRUE(easel.mosaic.layers(easel.mosaic.version())[0].tiles.empty());
}

TEST(Mosaic, VersionGrowsWithEachChangeAndRestart) {
  Easel easel;
  easel.draw(grid_at(0, 0, 1, 0.25, {100}));
  const auto first = easel.mosaic.version();
  EXPECT_EQ(first, 1'001'000U) << "its time in milliseconds";
  easel.draw(grid_at(0, 0, 1, 0.25, {100}));
  EXPECT_EQ(easel.mosaic.version(), first) << "no pixel changed";
  EXPECT_EQ(easel.mosaic.layers()[0].last, 1002) << "although a map arrived";
  easel.now = 0;
  easel.draw(grid_at(0, 0, 1, 0.25, {0}));
  EXPECT_GT(easel.mosaic.version(), first) << "a time that runs backward is the last one again";
  EXPECT_EQ(easel.mosaic.layers()[0].last, 1002);
}

TEST(Mosaic, ContinuesAnEarlierOneAfterAClockStepBack) {
  Easel earlier, easel;
  earlier.draw(grid_at(0, 0, 1, 0.25, {100}));  // at 1001
  easel.now = 500;
  easel.mosaic.restore(std::move(earlier.mosaic), 500);
  easel.draw(grid_at(0, 0, 1, 0.25, {0}));
  EXPECT_EQ(easel.seen(0.1, 0.1), kFree);
  EXPECT_EQ(easel.mosaic.layers()[0].last, 1001) << "a time that runs backward is the last one again";
}

TEST(Mosaic, WipeBlanksOnlyLaterTimes) {
  Easel easel;
  easel.draw(grid_at(0, 0, 1, 0.25, {100}));
  const auto before = easel.mosaic.version();
  const Canvas old = easel.mosaic.canvas(easel.layer);
  easel.mosaic.wipe(1500);
  EXPECT_EQ(easel.mosaic.wipe_time(), 1500);
  EXPECT_EQ(easel.seen(0.1, 0.1), 0);
  EXPECT_EQ(easel.seen(0.1, 0.1, 0, 1400), kOccupied);
  const auto layers = easel.mosaic.layers(before);
  ASSERT_EQ(layers[0].tiles.size(), 3U) << "a page must see the tile";
  EXPECT_TRUE(layers[0].tiles[0].blank);
  EXPECT_EQ(layers[0].bounds, std::nullopt);
  EXPECT_TRUE(easel.mosaic.canvas(easel.layer).tiles.empty());

  const auto late = draw(grid_at(0, 0, 1, 0.25, {100}), old);
  EXPECT_FALSE(easel.mosaic.apply(*late, 1501)) << "a drawing of the run before";
  easel.now = 1600;
  easel.draw(grid_at(3, 3, 1, 0.25, {0}));
  EXPECT_EQ(easel.seen(0.1, 0.1), 0);
  EXPECT_EQ(easel.seen(3.1, 3.1), kFree);
}

TEST(Mosaic, StaysWithinItsBudgetAndKeepsTheNewest) {
  constexpr std::size_t kBudget = 400'000;
  Easel easel{kBudget};
  for (unsigned i = 0; i < 100; ++i) {
    easel.draw(noisy(i));
    ASSERT_LE(easel.mosaic.bytes(), kBudget);
    ASSERT_EQ(easel.pixels({0, 0, 0}), [&] {
      Easel alone;
      alone.draw(noisy(i));
      return alone.pixels({0, 0, 0});
    }());
  }
  EXPECT_GT(easel.mosaic.spacing(), 1);
  EXPECT_GT(easel.mosaic.bytes(), kBudget / 4) << "the budget is used";
}

TEST(Mosaic, ThinsEvenlyOverTime) {
  constexpr std::size_t kBudget = 400'000;
  Easel easel{kBudget};
  for (unsigned i = 0; i < 100; ++i) easel.draw(noisy(i));  // from 1001 on, one a second
  std::set<std::uint32_t> states;
  for (double stamp = 1001; stamp < 1101; stamp += easel.mosaic.spacing()) {
    const auto shown = easel.mosaic.tile(easel.layer, {0, 0, 0}, stamp + easel.mosaic.spacing());
    ASSERT_NE(shown.tile, nullptr) << stamp;
    states.insert(shown.tile->crc);
  }
  EXPECT_GE(states.size(), 50 / easel.mosaic.spacing());
}

TEST(Mosaic, RejectsADrawingBeyondItsBudget) {
  Easel easel{60'000};
  easel.draw(noisy(1));
  const auto version = easel.mosaic.version();
  std::size_t refused = 0;
  for (unsigned i = 0; i < 10; ++i) {
    const auto map = noisy(i, 64.0 * i + 8);
    const auto drawing = draw(map, easel.mosaic.canvas(easel.layer));
    if (!easel.mosaic.apply(*drawing, 2000 + i)) ++refused;
    ASSERT_LE(easel.mosaic.bytes(), 60'000U);
  }
  EXPECT_GT(refused, 0U);
  EXPECT_EQ(easel.mosaic.layers()[0].missed, refused);
  EXPECT_GT(easel.mosaic.version(), version);
}

TEST(Mosaic, CountsMapsNotDrawn) {
  Mosaic mosaic;
  mosaic.on_missed({"ugv1", LayerKind::Cloud}, 5);
  mosaic.on_missed({"ugv1", LayerKind::Cloud}, 6);
  ASSERT_EQ(mosaic.layers().size(), 1U);
  EXPECT_EQ(mosaic.layers()[0].missed, 2U);
}

TEST(Mosaic, LimitsItsLayers) {
  Easel easel;
  for (std::size_t i = 0; i < Mosaic::kMostLayers; ++i) {
    easel.draw(of(icd::sentence("r", i).c_str(), grid_at(0, 0, 1, 0.25, {0})));
  }
  const auto map = of("onemore", grid_at(0, 0, 1, 0.25, {0}));
  EXPECT_FALSE(easel.mosaic.apply(*draw(map, easel.mosaic.canvas(layer_of(map))), 3000));
  EXPECT_EQ(easel.mosaic.layers().size(), Mosaic::kMostLayers);
  easel.mosaic.on_missed({"twomore", LayerKind::Cloud}, 3001);
  EXPECT_EQ(easel.mosaic.missed_maps(), 2U);
}

}  // namespace
}  // namespace adit::picture
