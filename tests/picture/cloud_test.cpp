#include <algorithm>
#include <limits>
#include <numbers>
#include <random>

#include "icd/xyz.hpp"
#include "picture/maps.hpp"
#include "picture/palette.hpp"

namespace adit::picture {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Cloud, ShowsTheHighestPointOfEachPixel) {
  Easel easel;
  easel.draw(cloud_of({{1.1, 2.1, 3}, {1.2, 2.2, 5}, {1.15, 2.15, -7}, {-40, -60, 0}}));
  EXPECT_EQ(easel.seen(1.1, 2.1), height_index(5));
  EXPECT_EQ(easel.seen(-40, -60), height_index(0));
  EXPECT_EQ(easel.seen(1.4, 2.1), 0);
}

TEST(Cloud, IsDrawnTheSameInAnyOrder) {
  const auto low = cloud_of({{1, 1, -2}, {2, 2, 4}}), high = cloud_of({{1, 1, 6}, {2, 2, 0}});
  Easel one, other;
  one.draw(low), one.draw(high);
  other.draw(high), other.draw(low);
  EXPECT_EQ(one.pixels({0, 0, 0}), other.pixels({0, 0, 0}));
  EXPECT_EQ(one.seen(1, 1), height_index(6));
  EXPECT_EQ(one.seen(2, 2), height_index(4));
}

TEST(Cloud, IsDrawnAtItsOrigin) {
  Easel easel;  // a quarter turn about z, and up by 2
  easel.draw(cloud_of({{1, 0.1, 0.5}}, icd::Pose{{10, 20, 2}, turned_by(std::numbers::pi / 2)}));
  EXPECT_EQ(easel.seen(9.9, 21), height_index(2.5));
  easel.draw(cloud_of({{3.1, 0, 0}}, icd::Pose{{0.1, 0.1, 0}, {0, -1, 0, 1}}));  // x points up
  EXPECT_EQ(easel.seen(0.1, 0.1), height_index(3.1));
}

struct Layout {
  const char* what;
  icd::Datatype datatype;
  bool big_endian;
  std::uint32_t x, y, z, step;
};
constexpr Layout kLayouts[] = {
    {"float32", icd::Datatype::Float32, false, 0, 4, 8, 12},
    {"float32, big-endian", icd::Datatype::Float32, true, 0, 4, 8, 12},
    {"float64, unaligned, in another order", icd::Datatype::Float64, false, 17, 1, 9, 40},
    {"float64, big-endian, padded", icd::Datatype::Float64, true, 0, 8, 16, 48},
    {"larger than a chunk", icd::Datatype::Float32, false, 0, 70'000, 140'000, 200'001},
};

template <class Float>
void put(std::uint8_t* to, double value, bool big_endian) {
  const auto number = static_cast<Float>(value);
  std::memcpy(to, &number, sizeof number);
  if (big_endian) std::reverse(to, to + sizeof number);
}

icd::MapUpdate laid_out(const Layout& layout, const std::vector<icd::Point>& points) {
  icd::PointCloud2 cloud;
  cloud.fields = {{"z", layout.z, layout.datatype, 1},
                  {"x", layout.x, layout.datatype, 1},
                  {"y", layout.y, layout.datatype, 1}};
  cloud.is_bigendian = layout.big_endian;
  cloud.point_step = layout.step;
  std::vector<std::uint8_t> bytes(points.size() * layout.step, 0xff);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::pair<std::uint32_t, double> values[] = {
        {layout.x, points[i].x}, {layout.y, points[i].y}, {layout.z, points[i].z}};
    for (const auto& [offset, value] : values) {
      std::uint8_t* to = bytes.data() + i * layout.step + offset;
      layout.datatype == icd::Datatype::Float32 ? put<float>(to, value, layout.big_endian)
                                                : put<double>(to, value, layout.big_endian);
    }
  }
  return with_data({icd::RobotName::parse("ugv1"), cloud, {}}, bytes);
}

TEST(Cloud, IsDrawnTheSameInAnyLayoutAndCompression) {
  std::mt19937_64 random{5};
  std::uniform_real_distribution<float> metres{-100, 100};
  std::vector<icd::Point> points;
  for (int i = 0; i < 12; ++i) points.push_back({metres(random), metres(random), metres(random) / 10});
  Easel plain;
  plain.draw(cloud_of(points));
  for (const Layout& layout : kLayouts) {
    for (const bool compressed : {false, true}) {
      Easel easel;
      const auto map = laid_out(layout, points);
      easel.draw(compressed ? gzipped(map) : map);
      for (int tile = 0; tile < 16; ++tile) {
        const TileIndex at{0, tile % 4 - 2, tile / 4 - 2};
        ASSERT_EQ(easel.pixels(at), plain.pixels(at)) << layout.what;
      }
    }
  }
}

TEST(Cloud, OmitsAndCountsPointsOutsideTheWorld) {
  Easel easel;
  const auto drawing = easel.draw(cloud_of({{1, 1, 1},
                                            {kNan, 1, 1},
                                            {1, kNan, 1},
                                            {1, 1, kNan},
                                            {kInfinity, 1, 1},
                                            {1, 1, -kInfinity},
                                            {1e30, 1, 1},
                                            {1, -8192.01, 1},
                                            {8192, 1, 1},
                                            {-8192, 1, 1}}));
  EXPECT_EQ(drawing.left_out, 8U);
  EXPECT_EQ(easel.seen(1, 1), height_index(1));
  EXPECT_EQ(easel.seen(-8192, 1), height_index(1)) << "the world's own border";
}

TEST(Cloud, TellsItsHeightsWithoutOutliers) {
  std::vector<icd::Point> points;
  for (int i = 0; i < 1000; ++i) points.push_back({i * 0.3, 0, 1 + i * 0.004});
  points.push_back({0, 50, 30}), points.push_back({1, 50, -19});
  Easel easel;
  const auto heights = easel.draw(cloud_of(points)).heights;
  ASSERT_TRUE(heights);
  EXPECT_NEAR(heights->low, 1, 0.3);
  EXPECT_NEAR(heights->high, 5, 0.3);
  EXPECT_EQ(easel.draw(cloud_of({})).heights, std::nullopt);
  const auto one = Easel{}.draw(cloud_of({{0, 0, 2.1}})).heights;
  ASSERT_TRUE(one);
  EXPECT_LE(one->low, 2.1);
  EXPECT_GE(one->high, 2.1);
}

TEST(Cloud, SamplesALargeCloudEvenly) {
  const icd::PointCloud2 cloud = icd::xyz();
  const std::size_t points = kMostPoints + kMostPoints / 8;
  std::vector<std::uint8_t> bytes(points * cloud.point_step);  // all at y = z = 0
  for (std::size_t i = 0; i < points; ++i) {
    const float x = static_cast<float>(i) * 200 / static_cast<float>(points);
    std::memcpy(bytes.data() + i * cloud.point_step, &x, sizeof x);
  }
  Easel easel;
  EXPECT_EQ(easel.draw(with_data({{}, cloud, {}}, bytes)).left_out, 0U);
  for (double x = 0.1; x < 199; x += 0.25) ASSERT_NE(easel.seen(x, 0), 0) << x;
}

}  // namespace
}  // namespace adit::picture
