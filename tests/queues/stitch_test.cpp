#include "queues/stitch.hpp"

#include <gmock/gmock.h>

#include "queues/maps.hpp"

namespace adit::queues {
namespace {

using testing::ElementsAre;

std::vector<std::size_t> which(const std::vector<Cells>& grids) {
  return stitch(grids).which;
}

TEST(Stitch, JoinsGridsThatFillARectangle) {
  const auto row = stitch(std::vector<Cells>{{0, 0, 4, 4}, {4, 0, 4, 4}, {-2, 0, 2, 4}});
  EXPECT_THAT(row.which, ElementsAre(0, 1, 2));
  EXPECT_EQ(row.cells, (Cells{-2, 0, 10, 4}));
  EXPECT_THAT(which({{0, 0, 4, 4}, {2, 0, 4, 4}}), ElementsAre(0, 1)) << "the grids overlap";
  EXPECT_THAT(which({{0, 0, 4, 4}, {1, 1, 2, 2}}), ElementsAre(0, 1))
      << "the newer grid lies within the older";
  EXPECT_THAT(which({{0, 0, 1, 6}, {0, 6, 1, 6}, {1, 0, 1, 12}}), ElementsAre(0, 1, 2));
}

TEST(Stitch, LeavesNoGap) {
  EXPECT_THAT(which({{0, 0, 4, 4}, {5, 0, 4, 4}}), ElementsAre(0)) << "a column lies between the grids";
  EXPECT_THAT(which({{0, 0, 4, 4}, {2, 2, 4, 4}}), ElementsAre(0)) << "two corners are missing";
  EXPECT_THAT(which({{0, 0, 4, 4}, {4, 0, 4, 4}, {0, 4, 4, 4}}), ElementsAre(0, 1))
      << "one corner is missing";
  EXPECT_THAT(which({{0, 0, 4, 4}, {4, 0, 4, 3}, {4, 3, 3, 1}}), ElementsAre(0)) << "one cell is missing";
}

TEST(Stitch, HasGapsOnlyIfTheirCellsAreKnown) {
  const std::vector<Cells> windows{{0, 0, 10, 10}, {2, 3, 10, 10}, {5, 5, 10, 10}};
  std::vector<Cells> asked;
  const auto found = stitch(windows, [&](const Cells& all, std::span<const Cells> those) {
    asked.push_back(all);
    return those.size() < 3;
  });
  EXPECT_THAT(found.which, ElementsAre(0, 1)) << "the third grid's size is unknown";
  EXPECT_TRUE(found.has_gaps);
  EXPECT_THAT(asked, ElementsAre(Cells{0, 0, 12, 13}, Cells{0, 0, 15, 15}));
  const auto row = stitch(std::vector<Cells>{{0, 0, 4, 4}, {4, 0, 4, 4}}, [](auto&&...) { return true; });
  EXPECT_FALSE(row.has_gaps);
}

TEST(Stitch, IsNotMuchLargerThanItsGrids) {
  const auto know_all = [](auto&&...) { return true; };
  EXPECT_EQ(stitch(std::vector<Cells>{{0, 0, 10, 10}, {70, 0, 10, 10}}, know_all).which.size(), 2);
  EXPECT_EQ(stitch(std::vector<Cells>{{0, 0, 10, 10}, {71, 0, 10, 10}}, know_all).which.size(), 1);
  EXPECT_EQ(stitch(std::vector<Cells>{{0, 0, 1500, 1500}, {1500, 1500, 1500, 1500}}, know_all).which.size(),
            1);
}

TEST(Stitch, NeedsTheRectangleFilledByAllTogether) {
  std::vector<Cells> tiles;
  for (const int place : {4, 0, 8, 5, 2, 7, 1, 6, 3}) tiles.push_back({place % 3 * 5, place / 3 * 5, 5, 5});
  EXPECT_EQ(stitch(tiles).which.size(), 9);
  EXPECT_EQ(stitch(tiles).cells, (Cells{0, 0, 15, 15}));
}

TEST(Stitch, MovesNoGridPastAnOverlappingOne) {
  const Cells first{0, 0, 4, 4}, corner{3, 3, 4, 4}, beside{4, 0, 4, 4}, far{40, 40, 4, 4};
  EXPECT_THAT(which({first, corner, beside}), ElementsAre(0))
      << "the corner grid is older than the grid that it overlaps";
  EXPECT_THAT(which({first, beside, corner}), ElementsAre(0, 1)) << "the corner grid is the last one";
  EXPECT_THAT(which({first, far, beside}), ElementsAre(0, 2));
}

TEST(Stitch, IsBounded) {
  EXPECT_THAT(which({{0, 0, 2048, 2048}, {2048, 0, 1, 2048}}), ElementsAre(0))
      << "the result has too many cells";
  EXPECT_THAT(which({{0, 0, 2048, 2047}, {0, 2047, 2048, 1}}), ElementsAre(0, 1));
  EXPECT_THAT(which({{0, 0, 4'000'000'000, 4'000'000'000}, {0, 0, 1, 1}}), ElementsAre(0));
  std::vector<Cells> many;
  for (std::int64_t i = 0; i < 200; ++i) many.push_back({i, 0, 1, 1});
  EXPECT_EQ(stitch(many).which.size(), kMostStitched);
}

TEST(Stitch, EndsSoonForAnyArrangement) {
  std::vector<Cells> stairs;
  for (std::int64_t i = 0; i < 64; ++i) stairs.push_back({i % 8 * 7, i * 5 % 64, 9 + i % 3, 9 + i % 5});
  EXPECT_GE(stitch(stairs).which.size(), 1);
}

TEST(StitchedGrid, HasTheNewestHeaderAndTheOutermostCorner) {
  auto older = grid(0.25, 0.5, 4, 4, 0.25), newer = grid(1.25, 0.5, 4, 4, 0.25);
  older.header.stamp = 1;
  newer.header.stamp = 2;
  const auto whole = stitch_grids(std::vector<const icd::OccupancyGrid*>{&older, &newer});
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->header.stamp, 2.0);
  EXPECT_EQ(whole->origin, older.origin);
  EXPECT_EQ(whole->width, 8);
  EXPECT_EQ(whole->height, 4);
}

TEST(StitchedGrid, LiesOnTheLatticeOfItsTurnedParts) {
  for (const icd::Quaternion turned : {icd::Quaternion{}, {0, 0, 0.6, 0.8}, {0.1, -0.3, 0.3, 0.9}}) {
    auto first = grid(0.1, 0.2, 3, 3, 0.1);
    first.origin.orientation = turned;
    auto left = first, below = first;
    left.origin = *corner_at(first, -3, 0);
    below.origin = *corner_at(first, 0, -3);
    const auto whole = stitch_grids(std::vector<const icd::OccupancyGrid*>{&first, &left, &below});
    ASSERT_TRUE(whole);
    EXPECT_EQ(cells_in(*whole, first), (Cells{3, 3, 3, 3}));
    EXPECT_EQ(cells_in(*whole, left), (Cells{0, 3, 3, 3}));
    EXPECT_EQ(cells_in(*whole, below), (Cells{3, 0, 3, 3}));
  }
}

}  // namespace
}  // namespace adit::queues
