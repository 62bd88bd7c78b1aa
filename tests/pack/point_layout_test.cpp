#include <gmock/gmock.h>

#include <numeric>
#include <span>

#include "pack/layouts.hpp"
#include "pack/points.hpp"

namespace adit::pack {
namespace {

using icd::Datatype;
using testing::ElementsAre;

icd::PointCloud2 cloud(std::vector<icd::FieldSchema> fields, std::uint32_t point_step) {
  return {.header = {},
          .origin = {},
          .fields = std::move(fields),
          .is_bigendian = false,
          .point_step = point_step};
}

/// A point in that layout whose bytes are their own offsets.
Bytes copied(const PointLayout& layout, std::uint32_t point_step) {
  Bytes point(point_step), to(layout.cloud.point_step);
  std::iota(point.begin(), point.end(), std::uint8_t{0});
  layout.copy(point, to);
  return to;
}

TEST(PointLayout, DropsPaddingBeforeBetweenAndAfterFields) {
  const auto before = cloud(
      {{"x", 2, Datatype::Float32, 1}, {"ring", 8, Datatype::Uint16, 1}, {"t", 12, Datatype::Int8, 2}}, 16);
  const auto tight = strip_padding(before);
  ASSERT_TRUE(tight);
  EXPECT_THAT(tight->cloud.fields, ElementsAre(icd::FieldSchema{"x", 0, Datatype::Float32, 1},
                                               icd::FieldSchema{"ring", 4, Datatype::Uint16, 1},
                                               icd::FieldSchema{"t", 6, Datatype::Int8, 2}));
  EXPECT_EQ(tight->cloud.point_step, 8);
  EXPECT_THAT(copied(*tight, 16), ElementsAre(2, 3, 4, 5, 8, 9, 12, 13));
}

TEST(PointLayout, KeepsTheOrderOfFields) {
  const auto before = cloud({{"b", 6, Datatype::Uint8, 1}, {"a", 1, Datatype::Uint16, 1}}, 8);
  const auto tight = strip_padding(before);
  ASSERT_TRUE(tight);
  EXPECT_THAT(tight->cloud.fields, ElementsAre(icd::FieldSchema{"b", 2, Datatype::Uint8, 1},
                                               icd::FieldSchema{"a", 0, Datatype::Uint16, 1}));
  EXPECT_THAT(copied(*tight, 8), ElementsAre(1, 2, 6));
}

TEST(PointLayout, WithoutPaddingIsUnchanged) {
  const auto before = cloud({{"x", 0, Datatype::Float32, 1}, {"y", 4, Datatype::Float64, 1}}, 12);
  const auto tight = strip_padding(before);
  ASSERT_TRUE(tight);
  EXPECT_EQ(tight->cloud, before);
  EXPECT_EQ(copied(*tight, 12), copied(plain_layout(before), 12));
}

TEST(PointLayout, KeepsAllOtherMembers) {
  auto before = cloud({{"x", 4, Datatype::Float32, 1}}, 12);
  before.header.stamp = 7;
  before.origin = icd::Pose{};
  before.is_bigendian = true;
  auto after = strip_padding(before)->cloud;
  EXPECT_EQ(after.fields.front().offset, 0);
  after.fields = before.fields;
  after.point_step = before.point_step;
  EXPECT_EQ(after, before);
}

TEST(PointLayout, IsUnchangedIfFieldsOverlap) {
  for (const std::uint32_t offset : {12u, 13u, 14u, 15u}) {
    EXPECT_FALSE(
        strip_padding(cloud({{"rgb", 12, Datatype::Float32, 1}, {"r", offset, Datatype::Uint8, 1}}, 32)))
        << offset;
  }
  EXPECT_FALSE(strip_padding(cloud({{"a", 0, Datatype::Float32, 4}, {"b", 8, Datatype::Float32, 1}}, 32)));
}

TEST(LayoutDeathTest, RequiresFieldsWithinThePoint) {
  EXPECT_DEATH(strip_padding(cloud({{"x", 8, Datatype::Float64, 1}}, 12)), "assertion failed");
  EXPECT_DEATH(strip_padding(cloud({{"x", 0, Datatype::Float64, 0xffffffff}}, 12)), "assertion failed");
}

}  // namespace
}  // namespace adit::pack
