#include <gmock/gmock.h>

#include <cmath>

#include "codec/bytes_of.hpp"
#include "codec/gzip.hpp"
#include "codec/write.hpp"
#include "forward/sample_maps.hpp"
#include "forward/stitched.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;

/// A row of cells of 1 m from `x` on.
icd::MapUpdate row_at(double x, const std::vector<std::uint8_t>& values) {
  icd::OccupancyGrid grid;
  grid.width = static_cast<std::uint32_t>(values.size());
  grid.height = 1;
  grid.resolution = 1;
  grid.origin.position.x = x;
  return {icd::RobotName::parse("r1"),
          grid,
          {codec::gzip(icd::ChunkedBytes{values}, codec::GzipStrategy::Runs), icd::Compression::Gzip,
           values.size()}};
}

queues::QueuedMap taken_of(const std::vector<icd::MapUpdate>& maps) {
  queues::MapQueue queue{0};
  std::uint64_t number = 0;
  for (const icd::MapUpdate& map : maps) queue.add(++number, map, queues::Instant{});
  return *queue.pop();
}

TEST(StitchedMap, HasTheCellsOfItsParts) {
  const auto waiting = taken_of({row_at(0, {1, 2, 3}), row_at(3, {4}), row_at(2, {5, 6, 7})});
  ASSERT_EQ(waiting.updates.size(), 3);
  const PackedMap map = pack_map(waiting);
  EXPECT_FALSE(map.body.empty());
  EXPECT_THAT(codec::bytes_of(map.stitched), ElementsAre(1, 2, 5, 6, 7));
}

TEST(StitchedMap, IsStitchedOnce) {
  auto waiting = taken_of({row_at(0, {1, 2, 3}), row_at(3, {4})});
  const PackedMap first = pack_map(waiting);
  waiting.map.data = first.stitched;
  const PackedMap second = pack_map(waiting);
  EXPECT_EQ(second.body, first.body);
  EXPECT_EQ(second.stitched.raw_size, 0);
}

TEST(StitchedMap, HasNoBodyIfAPartIsDamaged) {
  auto damaged = row_at(3, {4, 5, 6});
  auto bytes = damaged.data.bytes.to_vector();
  bytes[bytes.size() - 6] ^= 1;
  damaged.data.bytes = icd::ChunkedBytes{bytes};
  EXPECT_TRUE(pack_map(taken_of({row_at(0, {1, 2, 3}), damaged})).body.empty());
  const auto alone = taken_of({damaged});
  EXPECT_TRUE(pack_map(alone).body.empty()) << "detected by packing";
  EXPECT_TRUE(pack_map(alone, {.hurry = {.longest = 0}}).body.empty()) << "detected by drawing";
}

TEST(StitchedMap, FillsItsGapsWithSentCells) {
  queues::MapQueue queue{0};
  std::uint64_t number = 0;
  const auto take = [&](const std::vector<icd::MapUpdate>& maps) {
    for (const icd::MapUpdate& map : maps) queue.add(++number, map, queues::Instant{});
    auto waiting = *queue.pop();
    PackedMap map = pack_map(waiting);
    EXPECT_TRUE(map.drawn);
    if (map.drawn) queue.canvases().lay(waiting.map.name, *map.drawn);
    return map;
  };
  take({row_at(0, {1, 2, 3, 4})});
  EXPECT_THAT(codec::bytes_of(take({row_at(-1, {7, 8}), row_at(3, {9, 9})}).stitched),
              ElementsAre(7, 8, 2, 3, 9, 9));
  EXPECT_THAT(codec::bytes_of(take({row_at(4, {5}), row_at(7, {6})}).stitched),
              ElementsAre(5, icd::kUnknownCell, icd::kUnknownCell, 6))
      << "never sent";
}

/// A cloud from `begin` metres on, as taken from the queue.
queues::QueuedMap cloud_at(float begin, int points, queues::Precision precision) {
  std::vector<float> xs;
  for (int i = 0; i < points; ++i) xs.push_back(begin + 0.0137F * static_cast<float>(i * i % 997));
  return {.map = cloud_along_x("r1", xs), .accepted = {}, .updates = {1}, .precision = precision};
}

TEST(PackedCloud, HasItsPrecision) {
  using queues::Precision;
  for (const Precision each : {Precision::Exact, Precision::Millimetre, Precision::EightMillimetres}) {
    const PackedMap map = pack_map(cloud_at(5, 2000, each));
    EXPECT_EQ(map.precision, each);
    EXPECT_EQ(map.points_size, 2000 * 12);
  }
}

TEST(PackedCloud, IsExactIfItCannotBeRounded) {
  const auto precision_of = [](const queues::QueuedMap& waiting, bool arranges) {
    return pack_map(waiting, {.arranges_clouds = arranges}).precision;
  };
  using queues::Precision;
  EXPECT_EQ(precision_of(cloud_at(5, 2000, Precision::Millimetre), /*arranges=*/false), Precision::Exact);
  EXPECT_EQ(precision_of(cloud_at(9000, 2000, Precision::Millimetre), /*arranges=*/true), Precision::Exact);
  EXPECT_EQ(precision_of(cloud_at(5, 2, Precision::Millimetre), /*arranges=*/true), Precision::Exact)
      << "gzip does not make it smaller";
}

TEST(PackedMap, GoesAsItIsAfterTheSameChecks) {
  auto cloud = cloud_at(5, 2000, queues::Precision::Millimetre);
  cloud.packing = queues::PackingRule::LastAsItIs;
  EXPECT_EQ(pack_map(cloud).body, codec::write_map_update(cloud.map));
  cloud.map = cloud_along_x("r1", {1, NAN, 3});
  EXPECT_EQ(pack_map(cloud).body, codec::write_map_update(cloud_along_x("r1", {1, 3})));
  for (const icd::MapUpdate& map : {grid_of("r1", 50), row_at(0, {1, 2, 3})}) {
    queues::QueuedMap grid{
        .map = map, .accepted = {}, .updates = {1}, .packing = queues::PackingRule::LastAsItIs};
    EXPECT_EQ(pack_map(grid).body, codec::write_map_update(map));
  }
}

TEST(PackedCloud, IsUnchangedIfPackingNeedsTooMuchMemory) {
  constexpr std::size_t kMost = pack::kMostPacked / 12;
  for (const auto precision : {queues::Precision::Exact, queues::Precision::Millimetre}) {
    queues::QueuedMap waiting = cloud_at(5, 2000, precision);
    const auto is_packed = [&](std::size_t points) {
      waiting.map.data = cloud_along_x("r1", std::vector<float>(points)).data;
      const PackedMap map = pack_map(waiting);
      EXPECT_EQ(map.effort == pack::Effort::None, map.body.size() > waiting.map.data.raw_size);
      return map.effort == pack::Effort::Full;
    };
    EXPECT_TRUE(is_packed(kMost));
    EXPECT_FALSE(is_packed(kMost + 1));
  }
}

}  // namespace
}  // namespace adit::forward
