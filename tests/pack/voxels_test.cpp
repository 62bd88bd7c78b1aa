// In which voxel a point lies, whatever its bytes are.
#include "pack/voxels.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <numbers>

#include "pack/layouts.hpp"

namespace adit::pack {
namespace {

VoxelBlock voxel(const Layout& layout, double x, double y, double z, double edge = 0.5) {
  return Voxels(cloud_of(layout), edge).of(point_of(layout, x, y, z, 0));
}

VoxelBlock plain(double x, double y, double z) {
  return voxel(kLayouts[0], x, y, z);
}

TEST(Voxels, AreTheSameWhateverTheLayout) {
  for (const Layout& layout : kLayouts) {
    EXPECT_EQ(voxel(layout, 1.25, -7.75, 3.5), plain(1.25, -7.75, 3.5)) << layout.what;
    EXPECT_NE(voxel(layout, -7.75, 1.25, 3.5), plain(1.25, -7.75, 3.5)) << layout.what;
  }
}

TEST(Voxels, HaveTheirLowerSidesAndNotTheirUpper) {
  EXPECT_EQ(plain(0, 0, 0), plain(0.49, 0.49, 0.49));
  EXPECT_EQ(plain(-0.5, -0.5, -0.5), plain(-0.01, -0.01, -0.01));
  for (const double other : {-0.01, 0.5}) {
    EXPECT_NE(plain(0, 0, 0), plain(other, 0, 0));
    EXPECT_NE(plain(0, 0, 0), plain(0, other, 0));
    EXPECT_NE(plain(0, 0, 0), plain(0, 0, other));
  }
}

TEST(Voxels, AreToldApartWithinABlockAndBeyond) {
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

TEST(Voxels, ReachSoFarAndNoFurther) {
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
