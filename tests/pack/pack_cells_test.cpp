#include "pack/pack_cells.hpp"

#include <gtest/gtest.h>

#include "codec/gzip.hpp"
#include "codec/gzip_whole.hpp"
#include "pack/grids.hpp"
#include "pack/only_member.hpp"

namespace adit::pack {
namespace {

using Bytes = std::vector<std::uint8_t>;

icd::MapData packed(const Grid& grid) {
  const icd::MapUpdate update = grid.update();
  return pack_cells(std::get<icd::OccupancyGrid>(update.msg), update.data);
}

/// As it is kept.
icd::MapData kept(const Grid& grid, icd::ChunkedBytes member) {
  return {std::move(member), icd::Compression::Gzip, grid.cells.size()};
}

icd::MapData packed(const Grid& grid, const icd::MapData& data) {
  const icd::MapUpdate update = grid.update();
  return pack_cells(std::get<icd::OccupancyGrid>(update.msg), data);
}

std::size_t by_libdeflate(const Grid& grid, int level) {
  return codec::gzip_whole(grid.cells, level, 2 * grid.cells.size() + 100)->size();
}

void expect_sound(const Grid& grid, const icd::MapData& data) {
  SCOPED_TRACE(grid.what);
  EXPECT_EQ(data.raw_size, grid.cells.size());
  EXPECT_LE(data.bytes.size(), grid.cells.size());
  if (data.compression == icd::Compression::None) {
    EXPECT_EQ(data.bytes.to_vector(), grid.cells);
  } else {
    EXPECT_EQ(only_member(data.bytes, grid.cells.size()), grid.cells);
  }
}

std::vector<Grid> grids() {
  return {cave(400, 300, 1),           graded(cave(400, 300, 2)),
          speckled(cave(400, 300, 3)), measured(cave(400, 300, 4)),
          noise(300, 300, 101),        noise(300, 300, 2),
          noise(300, 300, 256),        Grid("all unknown", 2000, 1000),
          Grid("one row", 90'000, 1),  Grid("one column", 1, 90'000),
          Grid("one cell", 1, 1),      Grid("few cells", 20, 20)};
}

TEST(PackCells, GivesBackEachCellAndIsNeverLargerThanThey_HoweverTheyAreKept) {
  for (const Grid& grid : grids()) {
    const icd::MapData expected = packed(grid);
    expect_sound(grid, expected);
    for (const int level : {1, 6}) {
      const auto data =
          packed(grid, kept(grid, *codec::gzip_whole(grid.cells, level, 2 * grid.cells.size() + 100)));
      expect_sound(grid, data);
      EXPECT_LE(data.bytes.size(), expected.bytes.size()) << grid.what << " at " << level;
    }
  }
}

TEST(PackCells, LeavesWhatIsSmallerAsItIsKept) {
  const Grid grid = graded(cave(250, 250, 7));
  const icd::MapData smallest = kept(grid, *codec::gzip_whole(grid.cells, 12, grid.cells.size()));
  ASSERT_LT(smallest.bytes.size(), packed(grid).bytes.size());
  EXPECT_EQ(packed(grid, smallest), smallest);
}

TEST(PackCells, TakesLibdeflateWhereAGridRepeatsItselfElsewhere) {
  for (const Grid& grid : {graded(cave(400, 300, 8)), noise(300, 300, 2)}) {
    const std::size_t size = packed(grid).bytes.size();
    EXPECT_LE(size, by_libdeflate(grid, level_for(grid.cells.size()))) << grid.what;
    EXPECT_LE(size, by_libdeflate(grid, 6)) << grid.what;
  }
}

TEST(PackCells, TakesLibdeflateWhereThereAreNoRows) {
  Grid grid = cave(500, 500, 9);
  grid.width = grid.cells.size();
  grid.height = 1;
  EXPECT_LE(packed(grid).bytes.size(), by_libdeflate(grid, level_for(grid.cells.size())));
}

TEST(PackCells, IsNoLargerThanLibdeflateWhereThereAreFewCells) {
  for (const Grid& grid : {cave(100, 100, 1), graded(cave(200, 200, 2)), Grid("few cells", 20, 20),
                           Grid("few", 3, 2), noise(50, 50, 101)}) {
    EXPECT_LE(packed(grid).bytes.size(), by_libdeflate(grid, 9)) << grid.what;
  }
}

TEST(PackCells, SendsACellAsItIs) {
  const Grid grid("one cell", 1, 1);
  EXPECT_EQ(packed(grid), (icd::MapData{icd::ChunkedBytes(grid.cells), icd::Compression::None, 1}));
}

TEST(PackCells, LeavesWhatIsDamagedAsItIs) {
  const Grid grid = cave(300, 300, 3);
  Bytes member = codec::gzip(icd::ChunkedBytes(grid.cells), codec::GzipStrategy::Runs).to_vector();
  member[member.size() / 2] ^= 0x10;
  const icd::MapData damaged = kept(grid, icd::ChunkedBytes(member));
  EXPECT_EQ(packed(grid, damaged), damaged);
}

TEST(LevelFor, IsLowerForMoreCells) {
  int level = level_for(1);
  EXPECT_EQ(level, 9);
  for (std::size_t cells = 1; cells < 100'000'000; cells = cells * 3 / 2 + 1) {
    EXPECT_LE(level_for(cells), level);
    level = level_for(cells);
  }
  EXPECT_EQ(level, 6);
}

}  // namespace
}  // namespace adit::pack
