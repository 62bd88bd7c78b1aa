#include "pack/voxel_set.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace adit::pack {
namespace {

TEST(VoxelSet, HasWhatWasAddedAndNothingElse) {
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

TEST(VoxelSet, SaysWhatItWillHoldAndGrowsByHalvesOfThat) {
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

}  // namespace
}  // namespace adit::pack
