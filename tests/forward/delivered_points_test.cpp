// Points in voxels that the Command Post has are left out of later clouds.
#include <gmock/gmock.h>

#include <limits>

#include "codec/gzip.hpp"
#include "forward/sample_maps.hpp"
#include "forward/stitched.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class DeliveredPointsTest : public testing::Test {
 protected:
  DeliveredPointsTest() { points_.edges_are({{*icd::RobotName::parse("r1"), 0.5}}); }

  Packed pack(const icd::MapUpdate& map) {
    const queues::QueuedMap waiting{.map = map, .accepted = {}, .updates = {1}};
    return packed(waiting, points_.leaving_out(map));
  }
  Packed pack(const std::vector<float>& xs) { return pack(cloud_along_x("r1", xs)); }
  void take(const std::vector<float>& xs) { points_.taken(cloud_along_x("r1", xs), pack(xs).left_out); }

  DeliveredPoints points_;
};

TEST_F(DeliveredPointsTest, AreLeftOutOfTheNextCloud) {
  take({0.1F, 1.1F});
  const Packed next = pack({0.4F, 7, 1.4F});
  EXPECT_EQ(next.left_out.points, 2);
  ASSERT_TRUE(next.left_out.sent);
  EXPECT_THAT(xs_of(next.left_out.sent->data), ElementsAre(7));
  EXPECT_EQ(next.points_size, 12);
  EXPECT_FALSE(next.body.empty());
  EXPECT_FALSE(next.left_out.is_all);
}

TEST_F(DeliveredPointsTest, ExcludePointsThatWereOnlyPacked) {
  (void)pack({0.1F});
  EXPECT_EQ(pack({0.1F}).left_out.points, 0);
}

TEST_F(DeliveredPointsTest, CanBeAllFinitePointsOfACloud) {
  take({0.1F});
  const Packed next = pack({0.1F, std::numeric_limits<float>::quiet_NaN()});
  EXPECT_TRUE(next.left_out.is_all);
  EXPECT_TRUE(next.body.empty());
}

TEST_F(DeliveredPointsTest, BelongToRobotsWithAVoxelSize) {
  const icd::MapUpdate other = cloud_along_x("r2", {0.1F}), merged = cloud_along_x("", {0.1F});
  for (const icd::MapUpdate& map : {other, merged}) {
    points_.taken(map, pack(map).left_out);
    EXPECT_EQ(pack(map).left_out.points, 0);
  }
}

TEST_F(DeliveredPointsTest, IgnoreCompressedClouds) {
  take({0.1F});
  icd::MapUpdate map = cloud_along_x("r1", {0.1F});
  map.data = {codec::gzip(map.data.bytes, codec::GzipStrategy::Default), icd::Compression::Gzip, 12};
  EXPECT_EQ(pack(map).left_out.points, 0);
}

TEST_F(DeliveredPointsTest, AreForgottenInANewRun) {
  take({0.1F});
  const Packed with = pack({0.1F, 1}), without = pack({5, 6});
  EXPECT_TRUE(points_.hold(with.left_out));
  points_.forget();
  EXPECT_FALSE(points_.hold(with.left_out));
  EXPECT_TRUE(points_.hold(without.left_out)) << "nothing was left out";
  points_.taken(cloud_along_x("r1", {5, 6}), without.left_out);
  EXPECT_EQ(pack({5, 6, 0.1F}).left_out.points, 0) << "of the old run";
}

TEST_F(DeliveredPointsTest, AreForgottenIfTheSettingChanges) {
  take({0.1F});
  points_.edges_are({{*icd::RobotName::parse("r1"), 0.5}});
  EXPECT_EQ(pack({0.1F}).left_out.points, 1) << "unchanged";
  points_.edges_are({});
  EXPECT_EQ(pack({0.1F}).left_out.points, 0);
  points_.edges_are({{*icd::RobotName::parse("r1"), 0.5}});
  EXPECT_EQ(pack({0.1F}).left_out.points, 0);
}

}  // namespace
}  // namespace adit::forward
