#include "pack/pack_cells.hpp"

#include <gtest/gtest.h>

#include "codec/gzip.hpp"
#include "codec/gzip_whole.hpp"
#include "pack/grids.hpp"
#include "pack/only_member.hpp"

namespace adit::pack {
namespace {

/// As it is kept.
icd::MapData kept(const Grid& grid) {
  return {codec::gzip(icd::ChunkedBytes(grid.cells), codec::GzipStrategy::Runs), icd::Compression::Gzip,
          grid.cells.size()};
}

icd::MapData kept_by(int level, const Grid& grid) {
  return {*codec::gzip_whole(grid.cells, level, 2 * grid.cells.size() + 100), icd::Compression::Gzip,
          grid.cells.size()};
}

std::vector<Grid> grids() {
  return {cave(400, 300, 1),           graded(cave(400, 300, 2)),
          speckled(cave(400, 300, 3)), measured(cave(400, 300, 4)),
          noise(300, 300, 101),        noise(300, 300, 2),
          noise(300, 300, 256),        Grid("all unknown", 2000, 1000),
          Grid("one row", 90'000, 1),  Grid("few cells", 20, 20)};
}

TEST(PackCells, GivesBackEachCellAndIsNeverLargerThanThey_HoweverTheyAreKept) {
  for (const Grid& grid : grids()) {
    for (const icd::MapData& data : {kept(grid), kept_by(1, grid), kept_by(12, grid)}) {
      for (const Effort effort : {Effort::Quick, Effort::Full}) {
        SCOPED_TRACE(grid.what);
        const icd::MapData packed = *pack_cells(data, effort);
        EXPECT_EQ(packed.raw_size, grid.cells.size());
        EXPECT_LE(packed.bytes.size(), std::min(data.bytes.size(), grid.cells.size()));
        if (packed.compression == icd::Compression::None) {
          EXPECT_EQ(packed.bytes.to_vector(), grid.cells);
        } else {
          EXPECT_EQ(only_member(packed.bytes, grid.cells.size()), grid.cells);
        }
      }
    }
  }
}

TEST(PackCells, TakesLibdeflateIfItIsSmallerAndFullIfThereIsTime) {
  const Grid grid = graded(cave(400, 300, 8));
  EXPECT_EQ(pack_cells(kept(grid), Effort::Full), kept_by(kCellsLevel, grid));
  EXPECT_EQ(pack_cells(kept(grid), Effort::Quick), kept_by(kQuickCellsLevel, grid));
  EXPECT_EQ(pack_cells(kept(grid), Effort::None), kept(grid));
  EXPECT_EQ(pack_cells(kept_by(12, grid), Effort::Full), kept_by(12, grid));
}

TEST(PackCells, SendsACellAsItIs) {
  const Grid grid("one cell", 1, 1);
  const icd::MapData cell{icd::ChunkedBytes(grid.cells), icd::Compression::None, 1};
  EXPECT_EQ(pack_cells(kept(grid), Effort::Full), cell);
  EXPECT_EQ(pack_cells(cell, Effort::Full), cell);
}

TEST(PackCells, SaysThatDataIsDamaged) {
  icd::MapData damaged = kept(cave(300, 300, 3));
  std::vector<std::uint8_t> member = damaged.bytes.to_vector();
  member[member.size() / 2] ^= 0x10;
  damaged.bytes = icd::ChunkedBytes(member);
  EXPECT_EQ(pack_cells(damaged, Effort::Full), std::nullopt);
}

}  // namespace
}  // namespace adit::pack
