// Layout and order of a cloud's points after pack().
#include "pack/arrange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>

#include "codec/gzip.hpp"
#include "pack/generated.hpp"
#include "pack/layouts.hpp"
#include "pack/pack.hpp"
#include "pack/points.hpp"

namespace adit::pack {
namespace {

/// Unordered points of a survey, each padded to 32 bytes.
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

TEST(Arrange, MakesASurveySmaller) {
  const icd::MapUpdate map = survey(20'000);
  const icd::MapUpdate arranged = pack(map), as_it_came = pack(map, {.is_arranged = false});
  EXPECT_EQ(std::get<icd::PointCloud2>(arranged.msg).point_step, 16);
  EXPECT_EQ(arranged.data.raw_size, 20'000 * 16);
  EXPECT_LT(arranged.data.bytes.size(), as_it_came.data.bytes.size() * 9 / 10);
}

TEST(Arrange, KeepsTheOrderForLessEffort) {
  const icd::MapUpdate map = survey(20'000);
  const icd::MapUpdate quick = pack(map, {.effort = Effort::Quick}),
                       none = pack(map, {.effort = Effort::None});
  EXPECT_EQ(none, map);
  EXPECT_EQ(std::get<icd::PointCloud2>(quick.msg).point_step, 16);
  EXPECT_LT(quick.data.bytes.size(), map.data.bytes.size() / 2);
  EXPECT_GT(quick.data.bytes.size(), pack(map).data.bytes.size());
}

TEST(Arrange, IsDeterministic) {
  const icd::MapUpdate map = survey(3'000);
  EXPECT_EQ(pack(map), pack(map));
}

TEST(Arrange, IsTurnedOffByItsSetting) {
  const icd::MapUpdate map = survey(2'000);
  const icd::MapUpdate packed = pack(map, {.is_arranged = false});
  EXPECT_EQ(packed.msg, map.msg);
  EXPECT_EQ(inflated(packed), map.data.bytes.to_vector());
}

TEST(Arrange, KeepsPointsWithOverlappingFields) {
  icd::MapUpdate map = survey(2'000);
  std::get<icd::PointCloud2>(map.msg).fields.push_back({"r", 18, icd::Datatype::Uint8, 1});
  const icd::MapUpdate packed = pack(map);
  EXPECT_EQ(packed.msg, map.msg);
  EXPECT_EQ(inflated(packed), map.data.bytes.to_vector());
  EXPECT_EQ(packed.data.compression, icd::Compression::Gzip);
}

TEST(Arrange, DropsOnlyPaddingIfGzipDoesNotHelp) {
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

using Places = std::vector<Coordinates>;

std::vector<std::uint32_t> in(Layers layers, const Layout& layout, const Places& places) {
  Bytes bytes;
  Box box;
  for (const auto& [x, y, z] : places) {
    const Bytes point = point_of(layout, x, y, z, 0);
    bytes.insert(bytes.end(), point.begin(), point.end());
    box.add({x, y, z});
  }
  return numbers_in(layers, cloud_of(layout), box, bytes);
}

/// Whole numbers, so that each is one step.
Places some(std::mt19937_64& random, int count, int most) {
  std::uniform_int_distribution any{0, most};
  Places places{{0, 0, 0}};
  const double last = most;
  places.push_back({last, last, last});
  for (int i = 0; i < count; ++i) {
    places.push_back({static_cast<double>(any(random)), static_cast<double>(any(random)),
                      static_cast<double>(any(random))});
  }
  return places;
}

/// Checks the order: layers along `first`, then by the other axes.
void expect_sorted(Layers layers, std::size_t first, std::size_t second, std::size_t third) {
  std::mt19937_64 random{1};
  for (const Layout& layout : kLayouts) {
    if (layout.step > 1000) continue;
    for (const int most : {3, 15, 2047}) {
      const Places places = some(random, 600, most);
      std::vector<std::uint32_t> expected(places.size());
      std::iota(expected.begin(), expected.end(), 0U);
      std::ranges::stable_sort(expected, {}, [&](std::uint32_t number) {
        const Coordinates& at = places[number];
        return std::tuple(at[first], at[second], at[third]);
      });
      EXPECT_EQ(in(layers, layout, places), expected) << layout.what;
    }
  }
}

TEST(PointOrder, IsStableByThreeCoordinates) {
  expect_sorted(Layers::AlongX, 0, 2, 1);
  expect_sorted(Layers::AlongY, 1, 0, 2);
  expect_sorted(Layers::AlongZ, 2, 1, 0);
}

TEST(PointOrder, HasEachPointOnceForAnyCoordinates) {
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  const Places sets[] = {{},
                         {{1, 2, 3}},
                         Places(100, {5, 5, 5}),
                         {{most, 0, 0}, {-most, most, -most}, {0, 0, most}},
                         {{least, 0, -least}, {0, least, 0}, {-0.0, 0, 0}},
                         {{1, 1, 1}, {1, 1, 2}, {most, 1, 1}}};
  for (const Places& places : sets) {
    for (const Layers layers : {Layers::AlongX, Layers::AlongY, Layers::AlongZ}) {
      auto numbers = in(layers, kLayouts[2], places);
      std::ranges::sort(numbers);
      std::vector<std::uint32_t> all(places.size());
      std::iota(all.begin(), all.end(), 0U);
      EXPECT_EQ(numbers, all);
    }
  }
}

}  // namespace
}  // namespace adit::pack
