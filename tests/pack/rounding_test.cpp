// A receiver's view of a cloud with rounded coordinates, decoded by the rehearsal's Command Post.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>

#include "icd/geometry.hpp"
#include "pack/arrange.hpp"
#include "pack/generated.hpp"
#include "pack/pack.hpp"
#include "pack/read_back.hpp"

namespace adit::pack {
namespace {

using Places = std::vector<Coordinates>;

icd::PointCloud2 xyz_and_number(icd::Datatype datatype) {
  icd::PointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) {
    cloud.fields.push_back({name, cloud.point_step, datatype, 1});
    cloud.point_step += static_cast<std::uint32_t>(icd::size_of(datatype));
  }
  cloud.fields.push_back({"label", cloud.point_step, icd::Datatype::Uint32, 1});
  cloud.point_step += 4;
  return cloud;
}

/// Each point has its number, which identifies it.
icd::MapUpdate numbered(const icd::PointCloud2& form, const Places& places) {
  Bytes bytes(places.size() * form.point_step);
  const auto axes = icd::axes_of(form);
  for (std::uint32_t number = 0; number < places.size(); ++number) {
    std::uint8_t* const point = bytes.data() + number * form.point_step;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto narrow = static_cast<float>(places[number][axis]);
      if (form.fields.front().datatype == icd::Datatype::Float64) {
        std::memcpy(point + axes[axis], &places[number][axis], sizeof(double));
      } else {
        std::memcpy(point + axes[axis], &narrow, sizeof narrow);
      }
    }
    std::memcpy(point + form.fields.back().offset, &number, sizeof number);
  }
  return update_of(form, bytes);
}

/// The point in "darpa" as a float32 receiver computes it: the quaternion's matrix as in Eigen.
std::array<float, 3> to_float32(const Placement& origin, const std::array<float, 3>& p) {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  const float x = narrow(origin.orientation.x), y = narrow(origin.orientation.y),
              z = narrow(origin.orientation.z), w = narrow(origin.orientation.w);
  const float tx = 2 * x, ty = 2 * y, tz = 2 * z;
  const float turn[3][3] = {{1 - (ty * y + tz * z), ty * x - tz * w, tz * x + ty * w},
                            {ty * x + tz * w, 1 - (tx * x + tz * z), tz * y - tx * w},
                            {tz * x - ty * w, tz * y + tx * w, 1 - (tx * x + ty * y)}};
  const float at[3] = {narrow(origin.position.x), narrow(origin.position.y), narrow(origin.position.z)};
  std::array<float, 3> placed{};
  for (int row = 0; row < 3; ++row) {
    placed[row] = turn[row][0] * p[0] + turn[row][1] * p[1] + turn[row][2] * p[2] + at[row];
  }
  return placed;
}

/// The largest distance between a point and its place in `map`; nullopt if the cloud was not rounded.
std::optional<double> largest_error(const icd::MapUpdate& map, double unit) {
  const auto& before = std::get<icd::PointCloud2>(map.msg);
  const ReadBack after = read_back(pack(map, {.unit = unit}));
  const icd::Placement placed{before.origin.value_or(icd::Pose{})};
  const Placement origin = after.cloud.origin.value_or(Placement{});
  if (after.cloud.fields.front().datatype != 7 ||
      (before.origin && origin.position.x == before.origin->position.x) || !after.cloud.origin)
    return std::nullopt;
  const CoordinateReader was{before};
  const Bytes old = map.data.bytes.to_vector();
  const std::size_t step = after.cloud.point_step;
  EXPECT_EQ(after.data.size() / step, old.size() / before.point_step);
  std::vector<bool> seen(after.data.size() / step);
  double largest = 0;
  for (std::size_t i = 0; i < after.data.size(); i += step) {
    std::array<float, 3> p{};
    std::uint32_t number = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::memcpy(&p[axis], after.data.data() + i + after.cloud.fields[axis].offset, 4);
    std::memcpy(&number, after.data.data() + i + after.cloud.fields.back().offset, 4);
    EXPECT_FALSE(seen.at(number));
    seen.at(number) = true;
    const auto got = to_float32(origin, p);
    const auto at = was(std::span{old}.subspan(number * before.point_step, before.point_step));
    const icd::Point is = placed({at[0], at[1], at[2]});
    largest = std::max(largest, std::hypot(got[0] - is.x, got[1] - is.y, got[2] - is.z));
  }
  return largest;
}

icd::Quaternion any_turn(Generator& make) {
  return icd::rotation_of({make.real(-1, 1), make.real(-1, 1), make.real(-1, 1), make.real(-1, 1)}).value();
}

class Rounding : public testing::TestWithParam<std::uint64_t> {
 protected:
  Places places(double length, double away) {
    const Coordinates middle{make.real(-away, away), make.real(-away, away), make.real(-away, away)};
    Places all;
    for (int i = 0; i < 400; ++i) all.push_back(make.on_wall(middle, length));
    return all;
  }
  icd::PointCloud2 form() {
    return xyz_and_number(make.any(0, 1) == 0 ? icd::Datatype::Float64 : icd::Datatype::Float32);
  }
  Generator make{GetParam()};
};

TEST_P(Rounding, MovesPointsWithinItsBound) {
  int rounded = 0;
  for (int round = 0; round < 40; ++round) {
    for (const double unit : {kMillimetre, kEightMillimetres}) {
      const double length = std::pow(10, make.real(0, 4.5)), away = std::pow(10, make.real(0, 4.5));
      icd::PointCloud2 cloud = form();
      if (round % 2 == 1) cloud.origin = icd::Pose{{make.real(-away, away), make.real(-away, away), 5}, {}};
      const auto error = largest_error(numbered(cloud, places(length, away)), unit);
      rounded += error ? 1 : 0;
      EXPECT_LE(error.value_or(0), 1.3 * unit) << length << " long, " << away << " away";
    }
  }
  EXPECT_GT(rounded, 40);
}

TEST_P(Rounding, OfATurnedCloudMovesPointsWithinItsBound) {
  int rounded = 0;
  for (int round = 0; round < 60; ++round) {
    for (const double unit : {kMillimetre, kEightMillimetres}) {
      const double length = std::pow(10, make.real(0, 3.2)), away = std::pow(10, make.real(0, 3.8));
      icd::PointCloud2 cloud = form();
      cloud.origin = icd::Pose{{make.real(-away, away), make.real(-away, away), 5}, any_turn(make)};
      const auto error = largest_error(numbered(cloud, places(length, away)), unit);
      rounded += error ? 1 : 0;
      EXPECT_LE(error.value_or(0), 1.3 * unit) << length << " long, " << away << " away";
    }
  }
  EXPECT_GT(rounded, 40);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Rounding, testing::Range<std::uint64_t>(1, 4));

TEST_P(Rounding, ChangesOnlyCoordinates) {
  for (int round = 0; round < 10; ++round) {
    const icd::MapUpdate map = make.cloud(make.fields(/*is_bigendian=*/false), make.any(200, 2000),
                                          [&](std::size_t) { return make.on_wall({5, 6, 7}, 40); });
    const auto& before = std::get<icd::PointCloud2>(map.msg);
    const ReadBack after = read_back(pack(map, {.unit = kMillimetre}));
    ASSERT_TRUE(after.cloud.origin);
    auto was = values_of(before.fields, before.point_step, map.data.bytes.to_string(), {"x", "y", "z"});
    auto is = values_of(after.cloud.fields, after.cloud.point_step, after.data, {"x", "y", "z"});
    std::ranges::sort(was);
    std::ranges::sort(is);
    EXPECT_EQ(is, was);
    for (std::size_t i = 0; i < before.fields.size(); ++i)
      EXPECT_EQ(after.cloud.fields[i].name, before.fields[i].name);
  }
}

icd::MapUpdate tunnel(const icd::PointCloud2& form) {
  Generator make{3};
  Places places;
  for (int i = 0; i < 2000; ++i) places.push_back(make.on_wall({-10, 20, 1}, 30));
  return numbered(form, places);
}

TEST(RoundingOf, ATunnelMakesItSmaller) {
  const icd::MapUpdate map = tunnel(xyz_and_number(icd::Datatype::Float64));
  const std::size_t exact = pack(map).data.bytes.size(),
                    fine = pack(map, {.unit = kMillimetre}).data.bytes.size(),
                    coarse = pack(map, {.unit = kEightMillimetres}).data.bytes.size();
  EXPECT_LT(fine, exact * 7 / 10);
  EXPECT_LT(coarse, fine * 9 / 10);
}

TEST(RoundingOf, ACloudIsSkippedIfItsBoundCannotBeHeld) {
  const icd::MapUpdate map = tunnel(xyz_and_number(icd::Datatype::Float32));
  icd::MapUpdate big = map, turned = map, far = map, wide = map, endless = map;
  std::get<icd::PointCloud2>(big.msg).is_bigendian = true;
  auto& with_normals = std::get<icd::PointCloud2>(turned.msg);
  with_normals.origin = icd::Pose{{}, {0, 0, 0.6, 0.8}};
  with_normals.fields.back().name = "normal_x";
  std::get<icd::PointCloud2>(far.msg).origin = icd::Pose{{9000, 0, 0}, {}};
  wide = numbered(xyz_and_number(icd::Datatype::Float32), Places{{-4097, 0, 0}, {4097, 0, 0}, {1, 1, 1}});
  endless = numbered(xyz_and_number(icd::Datatype::Float64),
                     Places{{1e308, -1e308, 0}, {-1e308, 1e308, 1e-308}, {1, 2, 3}});
  for (const icd::MapUpdate& each : {big, turned, far, wide, endless}) {
    EXPECT_EQ(pack(each, {.unit = kMillimetre}), pack(each));
  }
  EXPECT_NE(pack(map, {.unit = kMillimetre}), pack(map));
  EXPECT_NE(pack(far, {.unit = kEightMillimetres}), pack(far));
}

TEST(RoundingOf, IsPartOfTheArrangement) {
  const icd::MapUpdate map = tunnel(xyz_and_number(icd::Datatype::Float32));
  EXPECT_EQ(pack(map, {.is_arranged = false, .unit = kMillimetre}), pack(map, {.is_arranged = false}));
}

TEST(RoundingOf, IsOnlyForFullEffort) {
  const icd::MapUpdate map = tunnel(xyz_and_number(icd::Datatype::Float32));
  for (const Effort effort : {Effort::None, Effort::Quick})
    EXPECT_EQ(pack(map, {.unit = kMillimetre, .effort = effort}), pack(map, {.effort = effort}));
}

TEST(RoundingOf, RecordedCloudsIsWithinItsBound) {
  const auto clouds = recorded_clouds();
  if (clouds.empty()) GTEST_SKIP() << "ADIT_MAPS names no folder of recorded maps";
  for (const icd::MapUpdate& recorded : clouds) {
    Places places;
    const auto& cloud = std::get<icd::PointCloud2>(recorded.msg);
    const CoordinateReader coordinates{cloud};
    const Bytes bytes = recorded.data.bytes.to_vector();
    for (std::size_t at = 0; at < bytes.size(); at += cloud.point_step)
      places.push_back(coordinates(std::span{bytes}.subspan(at, cloud.point_step)));
    for (const icd::Quaternion& turn : {icd::Quaternion{}, icd::Quaternion{0.1, -0.3, 0.3, 0.9}}) {
      icd::PointCloud2 form = xyz_and_number(icd::Datatype::Float32);
      form.origin = icd::Pose{{100, -50, 3}, turn};
      for (const double unit : {kMillimetre, kEightMillimetres}) {
        const auto error = largest_error(numbered(form, places), unit);
        ASSERT_TRUE(error);
        EXPECT_LE(*error, 1.3 * unit);
      }
    }
  }
}

}  // namespace
}  // namespace adit::pack
