// What pack() makes of a cloud's layout and order.
#include "pack/arrange.hpp"

#include <gtest/gtest.h>

#include "codec/map_pieces.hpp"
#include "pack/coordinates.hpp"
#include "pack/generated.hpp"
#include "pack/pack.hpp"

namespace adit::pack {
namespace {

/// Points of a survey in no order, each padded to 32 bytes.
icd::MapUpdate survey(std::size_t points) {
  Generator make{7};
  icd::PointCloud2 fields;
  fields.fields = {{"x", 0, icd::Datatype::Float32, 1},
                   {"y", 4, icd::Datatype::Float32, 1},
                   {"z", 8, icd::Datatype::Float32, 1},
                   {"rgb", 16, icd::Datatype::Uint32, 1}};
  fields.point_step = 32;
  return make.cloud(fields, points, [&](std::size_t) {
    auto at = make.on_wall({0, 0, 0}, 30);
    for (double& metres : at) metres = std::round(metres * 100) / 100;
    return at;
  });
}

Bytes inflated(const icd::MapUpdate& map) {
  Bytes out;
  EXPECT_TRUE(codec::for_each_piece(map.data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
    out.insert(out.end(), piece.begin(), piece.end());
    return {};
  }));
  return out;
}

TEST(Arrange, MakesASurveySmallerThanItsOrderDoes) {
  const icd::MapUpdate map = survey(20'000);
  const icd::MapUpdate arranged = pack(map), as_it_came = pack(map, {.is_arranged = false});
  EXPECT_EQ(std::get<icd::PointCloud2>(arranged.msg).point_step, 16);
  EXPECT_EQ(arranged.data.raw_size, 20'000 * 16);
  EXPECT_LT(arranged.data.bytes.size(), as_it_came.data.bytes.size() * 9 / 10);
}

TEST(Arrange, LeavesTheOrderAsItCameWhereACloudIsInAHurry) {
  const icd::MapUpdate map = survey(20'000);
  const icd::MapUpdate quick = pack(map, {.effort = Effort::Quick}),
                       none = pack(map, {.effort = Effort::None});
  EXPECT_EQ(none, map);
  EXPECT_EQ(std::get<icd::PointCloud2>(quick.msg).point_step, 16);
  EXPECT_LT(quick.data.bytes.size(), map.data.bytes.size() / 2);
  EXPECT_GT(quick.data.bytes.size(), pack(map).data.bytes.size());
}

TEST(Arrange, IsAlwaysTheSame) {
  const icd::MapUpdate map = survey(3'000);
  EXPECT_EQ(pack(map), pack(map));
}

TEST(Arrange, IsTurnedOffByItsSetting) {
  const icd::MapUpdate map = survey(2'000);
  const icd::MapUpdate packed = pack(map, {.is_arranged = false});
  EXPECT_EQ(packed.msg, map.msg);
  EXPECT_EQ(inflated(packed), map.data.bytes.to_vector());
}

TEST(Arrange, LeavesPointsWhoseFieldsShareBytesAsTheyAre) {
  icd::MapUpdate map = survey(2'000);
  std::get<icd::PointCloud2>(map.msg).fields.push_back({"r", 18, icd::Datatype::Uint8, 1});
  const icd::MapUpdate packed = pack(map);
  EXPECT_EQ(packed.msg, map.msg);
  EXPECT_EQ(inflated(packed), map.data.bytes.to_vector());
  EXPECT_EQ(packed.data.compression, icd::Compression::Gzip);
}

TEST(Arrange, OfPointsThatGzipDoesNotMakeSmallerDropsPaddingAlone) {
  const Layout& layout = kLayouts[4];
  const Bytes far = point_of(layout, 5, 6, 7, 9), near = point_of(layout, 1, 2, 3, 8);
  Bytes bytes = far;
  bytes.insert(bytes.end(), near.begin(), near.end());
  const icd::MapUpdate packed = pack(update_of(cloud_of(layout), bytes));
  EXPECT_EQ(packed.data.compression, icd::Compression::None);
  EXPECT_EQ(packed.data.raw_size, 2 * 13);
  const auto& cloud = std::get<icd::PointCloud2>(packed.msg);
  const CoordinateReader coordinates{cloud};
  const Bytes points = packed.data.bytes.to_vector();
  ASSERT_EQ(points.size(), 2 * 13);
  EXPECT_EQ(coordinates(std::span{points}.first(13)), (Coordinates{5, 6, 7})) << "in their order";
  EXPECT_EQ(coordinates(std::span{points}.last(13)), (Coordinates{1, 2, 3}));
}

}  // namespace
}  // namespace adit::pack
