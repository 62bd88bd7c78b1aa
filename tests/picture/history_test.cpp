#include <gmock/gmock.h>

#include "picture/mosaic.hpp"

namespace adit::picture {
namespace {

Tile tile(std::uint8_t what, std::size_t size = 100) {
  return std::make_shared<PackedTile>(PackedTile{std::vector<std::uint8_t>(size, what), what});
}

/// One version per second, with the second in `what`.
History over(int seconds, double spacing) {
  History history;
  for (int second = 0; second < seconds; ++second) {
    history.add(
        {1000.0 + second, static_cast<std::uint64_t>(second), tile(static_cast<std::uint8_t>(second))},
        spacing);
  }
  return history;
}

int shown(const History& history, double stamp) {
  const Version* version = history.at(stamp);
  return version == nullptr ? -1 : static_cast<int>(version->tile->crc);
}

TEST(History, ShowsTheTileOfATime) {
  const History history = over(10, 1);
  EXPECT_EQ(shown(history, 999.9), -1);
  EXPECT_EQ(shown(history, 1000), 0);
  EXPECT_EQ(shown(history, 1004.5), 4);
  EXPECT_EQ(shown(history, 1e12), 9);
  EXPECT_EQ(history.first().number, 0U);
  EXPECT_EQ(history.newest().number, 9U);
}

TEST(History, ShowsTilesWithinItsSpacing) {
  for (const double spacing : {1.0, 2.0, 4.0, 16.0}) {
    const History history = over(100, spacing);
    for (int second = 0; second < 100; ++second) {
      const int seen = shown(history, 1000.0 + second);
      EXPECT_LE(seen, second);
      EXPECT_TRUE(seen > second - spacing) << second << " with " << spacing;
    }
    EXPECT_EQ(shown(history, 2000), 99) << "the newest is always there";
  }
}

TEST(History, ThinnedIsLikeThinFromTheStart) {
  History history = over(100, 1);
  for (const double spacing : {2.0, 4.0, 8.0, 64.0, 1e11}) {
    history.thin(spacing);
    const History thin = over(100, spacing);
    EXPECT_EQ(history.cost(), thin.cost());
    for (int second = -1; second < 120; ++second) {
      ASSERT_EQ(shown(history, 1000.0 + second), shown(thin, 1000.0 + second)) << spacing << ' ' << second;
    }
  }
  EXPECT_EQ(history.first().number, 99U);
}

TEST(History, CostIsThatOfItsTiles) {
  History history;
  history.add({1, 1, tile(1, 5000)}, 1);
  const std::size_t one = history.cost();
  EXPECT_GE(one, 5000U);
  history.add({1.5, 2, tile(2, 3000)}, 1);
  EXPECT_EQ(history.cost(), one - 2000);
  history.add({2.5, 3, nullptr}, 1);
  EXPECT_LT(history.cost(), one - 2000 + 200) << "a blank tile costs next to nothing";
}

}  // namespace
}  // namespace adit::picture
