#include "pack/taken_voxels.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>

#include "pack/layouts.hpp"

namespace adit::pack {
namespace {

constexpr double kEdge = 0.5;
const icd::RobotName kR1 = *icd::RobotName::parse("r1"), kR2 = *icd::RobotName::parse("r2");

/// A row of points along x, each with a tag of its own.
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

TEST_F(TakenVoxelsTest, LeavesOutPointsOfVoxelsThatHaveOne) {
  take({0.1, 1.1});
  const auto kept = rest({0.4, 0.6, 1.4, 5});
  EXPECT_EQ(kept.left_out, 2u);
  const Bytes all = row_of(kLayouts[0], {0.4, 0.6, 1.4, 5});
  Bytes expected(all.begin() + 13, all.begin() + 26);
  expected.insert(expected.end(), all.begin() + 39, all.end());
  EXPECT_EQ(kept.data.bytes.to_vector(), expected);
  EXPECT_EQ(kept.data.raw_size, expected.size());
}

TEST_F(TakenVoxelsTest, LeavesNothingOutThatWasNotTakenYet) {
  EXPECT_EQ(rest({0.1, 0.6, 1.1}).left_out, 0u);
  EXPECT_EQ(rest({0.1}).left_out, 0u) << "that was packed, but nobody said that it was taken";
}

TEST_F(TakenVoxelsTest, KeepsTheFirstOfEachVoxelOfACloud) {
  const auto kept = rest({0.1, 0.6, 5, 0.2, 0.9, 5.1, 0.1});
  EXPECT_EQ(kept.left_out, 4u);
  const Bytes all = row_of(kLayouts[0], {0.1, 0.6, 5});
  EXPECT_EQ(kept.data.bytes.to_vector(), all);
}

TEST_F(TakenVoxelsTest, CopiesNothingWhereNothingIsLeftOut) {
  const auto data = data_of(row_of(kLayouts[0], {1, 2, 3}));
  const auto kept = voxels_.leave_out(kR1, cloud_of(kLayouts[0]), data, kEdge);
  EXPECT_EQ(kept.data.bytes.chunks()[0]->data(), data.bytes.chunks()[0]->data());
}

TEST_F(TakenVoxelsTest, CanLeaveOutAll) {
  take({0.1});
  const auto kept = rest({0.2, 0.3});
  EXPECT_EQ(kept.left_out, 2u);
  EXPECT_TRUE(kept.data.bytes.empty());
}

TEST_F(TakenVoxelsTest, AreTheRobotsOwnAndOfOneEdge) {
  take({0.1});
  EXPECT_EQ(rest({0.1}, kR2).left_out, 0u);
  EXPECT_EQ(rest({0.1}, kR1, 0.25).left_out, 0u);
  take({7}, kR1, 0.25);
  EXPECT_EQ(rest({7}, kR1, 0.25).left_out, 1u);
  EXPECT_EQ(rest({0.1}).left_out, 0u) << "those of the other edge are forgotten";
}

TEST_F(TakenVoxelsTest, KeepPointsThatAreInNoVoxel) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  take({1e30, kInfinite});
  EXPECT_EQ(rest({1e30, kInfinite}).left_out, 0u);
}

TEST_F(TakenVoxelsTest, WorkWithEveryLayoutHoweverItIsCut) {
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

TEST_F(TakenVoxelsTest, AreForgotten) {
  take({0.1});
  voxels_.forget();
  EXPECT_EQ(rest({0.1}).left_out, 0u);
  EXPECT_EQ(voxels_.bytes(), 0u);
}

TEST(TakenVoxelsBound, ForgetsTheRobotThatWasSilentForLongestAndThenTheOneItself) {
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

}  // namespace
}  // namespace adit::pack
