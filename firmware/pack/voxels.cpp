#include "pack/voxels.hpp"

namespace adit::pack {
namespace {

constexpr unsigned kBitsInBlock = 2;                        // of an index: the voxel within its block
constexpr unsigned kBitsOfBlock = 21 - kBitsInBlock;        // of an index: the block
constexpr std::uint64_t kIsThere = std::uint64_t{1} << 63;  // set in the place of each block

}  // namespace

Voxels::Voxels(const icd::PointCloud2& cloud, double edge) : coordinates_(cloud), per_metre_(1 / edge) {
  if (cloud.origin && *cloud.origin != icd::Pose{}) placement_.emplace(*cloud.origin);
}

/// Indexes start at the lowest within reach, so they are not negative and truncation rounds down.
VoxelBlock Voxels::of(std::span<const std::uint8_t> point) const {
  const auto [x, y, z] = coordinates_(point);
  icd::Point at{x, y, z};
  if (placement_) at = (*placement_)(at);
  VoxelBlock found{kIsThere, 0};
  unsigned within = 0;
  for (const double metres : {at.x, at.y, at.z}) {
    const double index = metres * per_metre_ + kReach;
    if (!(index >= 0 && index < 2.0 * kReach)) return {};  // also if it is not a number
    const auto whole = static_cast<std::uint32_t>(index);
    found.place = found.place << kBitsOfBlock | whole >> kBitsInBlock;
    within = within << kBitsInBlock | (whole & ((1u << kBitsInBlock) - 1));
  }
  found.place |= kIsThere;
  found.voxels = std::uint64_t{1} << within;
  return found;
}

}  // namespace adit::pack
