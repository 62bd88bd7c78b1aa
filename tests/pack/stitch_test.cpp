#include "pack/stitch.hpp"

#include <gmock/gmock.h>

#include <string_view>

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

}  // namespace
}  // namespace adit::pack
