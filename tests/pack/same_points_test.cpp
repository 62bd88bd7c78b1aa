// The rehearsal's Command Post decodes a packed cloud to the same set of points: each field of each point,
// bit for bit.
#include <gtest/gtest.h>

#include "icd/xyz.hpp"
#include "pack/generated.hpp"
#include "pack/pack.hpp"
#include "pack/read_back.hpp"

namespace adit::pack {
namespace {

std::vector<std::string> sorted(std::vector<std::string> points) {
  std::ranges::sort(points);
  return points;
}

/// Checks a map that was packed with little effort.
void expect_same_in_order(const icd::MapUpdate& map, Effort effort) {
  const auto& before = std::get<icd::PointCloud2>(map.msg);
  const ReadBack after = read_back(pack(map, {.effort = effort}));
  EXPECT_EQ(values_of(after.cloud.fields, after.cloud.point_step, after.data),
            values_of(before.fields, before.point_step, map.data.bytes.to_string()));
}

void expect_same_points(const icd::MapUpdate& map) {
  for (const Effort effort : {Effort::None, Effort::Quick}) expect_same_in_order(map, effort);
  const auto& before = std::get<icd::PointCloud2>(map.msg);
  const ReadBack after = read_back(pack(map));
  EXPECT_EQ(sorted(values_of(after.cloud.fields, after.cloud.point_step, after.data)),
            sorted(values_of(before.fields, before.point_step, map.data.bytes.to_string())));
  EXPECT_EQ(after.cloud.is_bigendian, before.is_bigendian);
  EXPECT_EQ(after.cloud.origin.has_value(), before.origin.has_value());
  ASSERT_EQ(after.cloud.fields.size(), before.fields.size());
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < before.fields.size(); ++i) {
    EXPECT_EQ(after.cloud.fields[i].name, before.fields[i].name);
    EXPECT_EQ(after.cloud.fields[i].datatype, static_cast<std::uint32_t>(before.fields[i].datatype));
    EXPECT_EQ(after.cloud.fields[i].count, before.fields[i].count);
    bytes += icd::size_of(before.fields[i].datatype) * before.fields[i].count;
  }
  EXPECT_EQ(after.cloud.point_step, bytes) << "no padding";
}

class SamePoints : public testing::TestWithParam<std::uint64_t> {};

TEST_P(SamePoints, AreInACloudOfAnyFields) {
  Generator make{GetParam()};
  for (int round = 0; round < 6; ++round) {
    const icd::PointCloud2 fields = make.fields(/*is_bigendian=*/false);
    const double cell = round % 3 == 0 ? 0.05 : 1e-9;  // surveyed, or noise
    expect_same_points(make.cloud(fields, make.any(0, 2000), [&](std::size_t) {
      auto at = make.on_wall({-20, 3, 1000}, 30);
      for (double& metres : at) metres = std::round(metres / cell) * cell;
      return at;
    }));
  }
}

TEST_P(SamePoints, AreInACloudOfAnyCoordinates) {
  Generator make{GetParam()};
  const icd::PointCloud2 fields = make.fields(/*is_bigendian=*/GetParam() % 2 == 0);
  expect_same_points(make.cloud(fields, 500, [&](std::size_t) -> std::array<double, 3> {
    const auto any = [&] { return std::ldexp(make.real(-1, 1), static_cast<int>(make.any(0, 240)) - 120); };
    return {any(), any(), any()};
  }));
}

INSTANTIATE_TEST_SUITE_P(Seeds, SamePoints, testing::Range<std::uint64_t>(1, 6));

TEST(SamePointsOf, ACloudOfSeveralBlocks) {
  std::mt19937 random{1};
  Bytes bytes(12 * 530'000);
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    const auto metres = static_cast<float>(random() % 10'000) / 100;
    std::memcpy(bytes.data() + at, &metres, sizeof metres);
  }
  const ReadBack after = read_back(pack(update_of(icd::xyz(), bytes)));
  const auto sum_of = [](std::string_view points) {  // independent of their order
    std::size_t sum = 0;
    for (; !points.empty(); points.remove_prefix(12))
      sum += std::hash<std::string_view>()(points.substr(0, 12));
    return sum;
  };
  ASSERT_EQ(after.data.size(), bytes.size());
  EXPECT_EQ(sum_of(after.data), sum_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
}

TEST(SamePointsOf, RecordedClouds) {
  const auto clouds = recorded_clouds();
  if (clouds.empty()) GTEST_SKIP() << "ADIT_MAPS names no folder of recorded maps";
  for (const icd::MapUpdate& cloud : clouds) expect_same_points(cloud);
}

}  // namespace
}  // namespace adit::pack
