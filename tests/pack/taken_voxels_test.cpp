#include "pack/taken_voxels.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <initializer_list>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "pack/layouts.hpp"

namespace adit::pack {
namespace {

constexpr double kEdge = 0.5;
const icd::RobotName kR1 = *icd::RobotName::parse("r1"), kR2 = *icd::RobotName::parse("r2");

/// A row of points along x, each with its own tag.
Bytes row_of(const Layout& layout, std::initializer_list<double> xs) {
  Bytes bytes;
  std::uint8_t tag = 0;
  for (const double x : xs) {
    const Bytes point = point_of(layout, x, 0, 0, ++tag);
    bytes.insert(bytes.end(), point.begin(), point.end());
  }
  return bytes;
}

icd::MapData data_of(const Bytes& bytes) {
  return {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()};
}

class TakenVoxelsTest : public testing::Test {
 protected:
  TakenVoxels::Rest rest(std::initializer_list<double> xs, const icd::RobotName& robot = kR1,
                         double edge = kEdge) const {
    return voxels_.leave_out(robot, cloud_of(kLayouts[0]), data_of(row_of(kLayouts[0], xs)), edge);
  }
  void take(std::initializer_list<double> xs, const icd::RobotName& robot = kR1, double edge = kEdge) {
    voxels_.add(robot, edge, rest(xs, robot, edge).voxels);
  }

  TakenVoxels voxels_;
};

TEST_F(TakenVoxelsTest, OmitsPointsOfDeliveredVoxels) {
  take({0.1, 1.1});
  const auto kept = rest({0.4, 0.6, 1.4, 5});
  EXPECT_EQ(kept.left_out, 2u);
  const Bytes all = row_of(kLayouts[0], {0.4, 0.6, 1.4, 5});
  Bytes expected(all.begin() + 13, all.begin() + 26);
  expected.insert(expected.end(), all.begin() + 39, all.end());
  EXPECT_EQ(kept.data.bytes.to_vector(), expected);
  EXPECT_EQ(kept.data.raw_size, expected.size());
}

TEST_F(TakenVoxelsTest, KeepsPointsOfUndeliveredVoxels) {
  EXPECT_EQ(rest({0.1, 0.6, 1.1}).left_out, 0u);
  EXPECT_EQ(rest({0.1}).left_out, 0u) << "the cloud was packed, but its delivery is unknown";
}

TEST_F(TakenVoxelsTest, KeepsTheFirstOfEachVoxelOfACloud) {
  const auto kept = rest({0.1, 0.6, 5, 0.2, 0.9, 5.1, 0.1});
  EXPECT_EQ(kept.left_out, 4u);
  const Bytes all = row_of(kLayouts[0], {0.1, 0.6, 5});
  EXPECT_EQ(kept.data.bytes.to_vector(), all);
}

TEST_F(TakenVoxelsTest, CopiesNothingIfNothingIsOmitted) {
  const auto data = data_of(row_of(kLayouts[0], {1, 2, 3}));
  const auto kept = voxels_.leave_out(kR1, cloud_of(kLayouts[0]), data, kEdge);
  EXPECT_EQ(kept.data.bytes.chunks()[0]->data(), data.bytes.chunks()[0]->data());
}

TEST_F(TakenVoxelsTest, MayOmitAllPoints) {
  take({0.1});
  const auto kept = rest({0.2, 0.3});
  EXPECT_EQ(kept.left_out, 2u);
  EXPECT_TRUE(kept.data.bytes.empty());
}

TEST_F(TakenVoxelsTest, ArePerRobotAndEdge) {
  take({0.1});
  EXPECT_EQ(rest({0.1}, kR2).left_out, 0u);
  EXPECT_EQ(rest({0.1}, kR1, 0.25).left_out, 0u);
  take({7}, kR1, 0.25);
  EXPECT_EQ(rest({7}, kR1, 0.25).left_out, 1u);
  EXPECT_EQ(rest({0.1}).left_out, 0u) << "voxels at the other edge are forgotten";
}

TEST_F(TakenVoxelsTest, KeepsPointsOutsideAllVoxels) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  take({1e30, kInfinite});
  EXPECT_EQ(rest({1e30, kInfinite}).left_out, 0u);
}

TEST_F(TakenVoxelsTest, WorksWithAnyLayoutInAnyPieces) {
  std::mt19937_64 random{1};
  for (const Layout& layout : kLayouts) {
    TakenVoxels taken;
    const icd::PointCloud2 cloud = cloud_of(layout);
    const Bytes older = row_of(layout, {1, 2, 3}), newer = row_of(layout, {1, 2, 3, 4});
    taken.add(kR1, kEdge, taken.leave_out(kR1, cloud, cut_up(older, random), kEdge).voxels);
    const auto kept = taken.leave_out(kR1, cloud, cut_up(newer, random), kEdge);
    EXPECT_EQ(kept.data.bytes.to_vector(), Bytes(newer.end() - layout.step, newer.end())) << layout.what;
  }
}

TEST_F(TakenVoxelsTest, CanBeForgotten) {
  take({0.1});
  voxels_.forget();
  EXPECT_EQ(rest({0.1}).left_out, 0u);
  EXPECT_EQ(voxels_.bytes(), 0u);
}

TEST(TakenVoxelsBound, ForgetsTheLongestSilentRobotFirst) {
  constexpr std::size_t kMost = 95 << 10;
  TakenVoxels taken{kMost};
  std::vector<VoxelBlock> few(100), many(3'000), too_many(7'000);
  for (std::vector<VoxelBlock>* all : {&few, &many, &too_many}) {
    for (std::size_t i = 0; i < all->size(); ++i) (*all)[i] = {i + 1, 1};
  }
  const icd::RobotName r3 = *icd::RobotName::parse("r3");
  taken.add(kR1, kEdge, few);
  taken.add(kR2, kEdge, few);
  taken.add(kR1, kEdge, few);
  taken.add(r3, kEdge, many);
  EXPECT_EQ(taken.bytes(), (64 << 10) + (16 << 10)) << "r2 is forgotten";
  taken.add(r3, kEdge, too_many);
  EXPECT_LE(taken.bytes(), kMost);
  EXPECT_GT(taken.bytes(), 0u);
}

TEST(VoxelSet, HasExactlyTheAddedVoxels) {
  std::mt19937_64 random{1};
  VoxelSet set;
  std::map<std::uint64_t, std::uint64_t> all;
  EXPECT_EQ(set.voxels_at(1), 0u);
  for (int i = 0; i < 20'000; ++i) {
    const VoxelBlock block{1 + random() % 10'000, std::uint64_t{1} << random() % 64};
    EXPECT_EQ(set.voxels_at(block.place), all[block.place]);
    set.add(block);
    all[block.place] |= block.voxels;
  }
  for (const auto& [place, voxels] : all) EXPECT_EQ(set.voxels_at(place), voxels);
}

TEST(VoxelSet, PredictsItsSizeAndGrowsByHalf) {
  VoxelSet set;
  EXPECT_EQ(set.bytes(), 0u);
  for (std::uint64_t place = 1; place < 5'000; ++place) {
    const std::size_t next = set.bytes_with_another();
    set.add({place, 1});
    EXPECT_EQ(set.bytes(), next);
    EXPECT_LE(place * sizeof(VoxelBlock) * 4, set.bytes() * 3);
  }
  const std::size_t bytes = set.bytes();
  set.add({1, 2});
  EXPECT_EQ(set.bytes(), bytes) << "another voxel of a block";
}

// The voxel of a point, whatever its bytes.

VoxelBlock voxel(const Layout& layout, double x, double y, double z, double edge = 0.5) {
  return Voxels(cloud_of(layout), edge).of(point_of(layout, x, y, z, 0));
}

VoxelBlock plain(double x, double y, double z) {
  return voxel(kLayouts[0], x, y, z);
}

TEST(Voxels, AreTheSameForAnyLayout) {
  for (const Layout& layout : kLayouts) {
    EXPECT_EQ(voxel(layout, 1.25, -7.75, 3.5), plain(1.25, -7.75, 3.5)) << layout.what;
    EXPECT_NE(voxel(layout, -7.75, 1.25, 3.5), plain(1.25, -7.75, 3.5)) << layout.what;
  }
}

TEST(Voxels, IncludeTheirLowerButNotTheirUpperSides) {
  EXPECT_EQ(plain(0, 0, 0), plain(0.49, 0.49, 0.49));
  EXPECT_EQ(plain(-0.5, -0.5, -0.5), plain(-0.01, -0.01, -0.01));
  for (const double other : {-0.01, 0.5}) {
    EXPECT_NE(plain(0, 0, 0), plain(other, 0, 0));
    EXPECT_NE(plain(0, 0, 0), plain(0, other, 0));
    EXPECT_NE(plain(0, 0, 0), plain(0, 0, other));
  }
}

TEST(Voxels, AreDistinctWithinABlockAndBeyond) {
  std::uint64_t voxels = 0;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      for (int z = 0; z < 4; ++z) {
        const VoxelBlock at = plain(x / 2.0, y / 2.0, z / 2.0);
        EXPECT_EQ(at.place, plain(0, 0, 0).place);
        EXPECT_EQ(std::popcount(at.voxels), 1);
        voxels |= at.voxels;
      }
    }
  }
  EXPECT_EQ(voxels, ~std::uint64_t{0});
  EXPECT_NE(plain(2, 0, 0).place, plain(0, 0, 0).place);
}

TEST(Voxels, HaveABoundedRange) {
  const Layout& layout = kLayouts[2];  // float64
  const double reach = static_cast<double>(Voxels::kReach) / 2;
  EXPECT_NE(voxel(layout, reach - 0.25, -reach, 0).place, 0u);
  EXPECT_NE(voxel(layout, reach - 0.25, -reach, 0), voxel(layout, -reach, reach - 0.25, 0));
  for (const double far : {reach, -reach - 0.25, 1e30, -1e30, std::numeric_limits<double>::max(),
                           std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(voxel(layout, far, 0, 0), VoxelBlock{}) << far;
    EXPECT_EQ(voxel(layout, 0, far, 0), VoxelBlock{}) << far;
    EXPECT_EQ(voxel(layout, 0, 0, far), VoxelBlock{}) << far;
  }
}

TEST(Voxels, AreThoseOfTheCommonFrame) {
  icd::PointCloud2 cloud = cloud_of(kLayouts[0]);
  const double half = std::numbers::sqrt2 / 2;  // a quarter turn about z
  cloud.origin = icd::Pose{{10, 20, 30}, {0, 0, half, half}};
  EXPECT_EQ(Voxels(cloud, 0.5).of(point_of(kLayouts[0], 1.25, 2.25, 3.25, 0)), plain(7.75, 21.25, 33.25));
  cloud.origin = icd::Pose{{1e300, 0, 0}, {1e-300, 0, 0, 1e-300}};
  EXPECT_EQ(Voxels(cloud, 0.5).of(point_of(kLayouts[0], 1, 2, 3, 0)), VoxelBlock{}) << "beyond any reach";
}

}  // namespace
}  // namespace adit::pack
