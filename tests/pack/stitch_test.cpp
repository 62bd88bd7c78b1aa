#include "pack/stitch.hpp"

#include <gmock/gmock.h>

#include <string_view>

#include "codec/bytes_of.hpp"
#include "codec/gzip.hpp"

namespace adit::pack {
namespace {

using testing::ElementsAre;

icd::MapData cells(const std::vector<std::uint8_t>& values) {
  return {icd::ChunkedBytes{values}, icd::Compression::None, values.size()};
}

icd::MapData zipped(const std::vector<std::uint8_t>& values) {
  return {codec::gzip(icd::ChunkedBytes{values}, codec::GzipStrategy::Runs), icd::Compression::Gzip,
          values.size()};
}

TEST(StitchedCells, LieInTheirTiles) {
  const std::vector<Tile> tiles = {{cells({1, 2, 3, 4}), 0, 0, 2, 2}, {zipped({5, 6}), 2, 0, 1, 2}};
  const auto data = stitch(3, 2, tiles);
  ASSERT_TRUE(data);
  EXPECT_THAT(data->bytes.to_vector(), ElementsAre(1, 2, 5, 3, 4, 6));
  EXPECT_EQ(data->raw_size, 6);
  EXPECT_EQ(data->compression, icd::Compression::None);
}

TEST(StitchedCells, AreTheNewestKnownOrUnknown) {
  const std::vector<Tile> tiles = {{cells({1, 2, 3, 4}), 0, 0, 2, 2},
                                   {cells({icd::kUnknownCell, 9}), 1, 0, 1, 2}};
  EXPECT_THAT(stitch(2, 2, tiles)->bytes.to_vector(), ElementsAre(1, icd::kUnknownCell, 3, 9));
}

TEST(StitchedCells, AreTheSameInAnyPieces) {
  icd::MapData pieces{{}, icd::Compression::None, 6};
  const auto whole = std::make_shared<std::vector<std::uint8_t>>(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
  for (std::size_t i = 0; i < 6; ++i) pieces.bytes.append(whole, std::span(*whole).subspan(i, 1));
  EXPECT_THAT(stitch(3, 3, std::vector<Tile>{{pieces, 0, 1, 3, 2}})->bytes.to_vector(),
              ElementsAre(255, 255, 255, 1, 2, 3, 4, 5, 6));
}

TEST(StitchedCells, LieOverOlderCells) {
  EXPECT_THAT(stitch(3, 1, std::vector<Tile>{{cells({9}), 1, 0, 1, 1}}, {1, 2, 3})->bytes.to_vector(),
              ElementsAre(1, 9, 3));
}

TEST(StitchedCells, AreRejectedIfATileIsDamaged) {
  icd::MapData damaged = zipped({1, 2, 3, 4});
  auto bytes = damaged.bytes.to_vector();
  bytes[bytes.size() / 2] ^= 0x55;
  damaged.bytes = icd::ChunkedBytes{bytes};
  EXPECT_FALSE(stitch(2, 2, std::vector<Tile>{{damaged, 0, 0, 2, 2}}));
}

TEST(CutCells, AreThoseOfTheirTiles) {
  std::vector<Tile> tiles = {{{}, 1, 0, 2, 1}, {{}, 0, 1, 1, 2}, {{}, 2, 2, 1, 1}};
  for (const icd::MapData& from : {cells({1, 2, 3, 4, 5, 6, 7, 8, 9}), zipped({1, 2, 3, 4, 5, 6, 7, 8, 9})}) {
    ASSERT_TRUE(cut(from, 3, tiles));
    EXPECT_THAT(codec::bytes_of(tiles[0].data), ElementsAre(2, 3));
    EXPECT_THAT(codec::bytes_of(tiles[1].data), ElementsAre(4, 7));
    EXPECT_THAT(codec::bytes_of(tiles[2].data), ElementsAre(9));
    EXPECT_EQ(tiles[0].data.raw_size, 2);
  }
}

TEST(CutCells, AreTheSameInAnyPieces) {
  icd::MapData pieces{{}, icd::Compression::None, 6};
  const auto whole = std::make_shared<std::vector<std::uint8_t>>(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
  for (const auto& [from, size] : {std::pair(0, 1), {1, 4}, {5, 1}})
    pieces.bytes.append(whole, std::span(*whole).subspan(from, size));
  std::vector<Tile> tiles = {{{}, 1, 0, 2, 2}};
  ASSERT_TRUE(cut(pieces, 3, tiles));
  EXPECT_THAT(codec::bytes_of(tiles[0].data), ElementsAre(2, 3, 5, 6));
}

}  // namespace
}  // namespace adit::pack
