#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "icd/map_update.hpp"
#include "icd/placement.hpp"
#include "pack/coordinates.hpp"

namespace adit::pack {

/// Some voxels of one block, which is a cube of 4 x 4 x 4 voxels.
struct VoxelBlock {
  std::uint64_t place = 0;   // of the block; 0: there is none
  std::uint64_t voxels = 0;  // a bit for each that is meant
  friend bool operator==(const VoxelBlock&, const VoxelBlock&) = default;
};

/// In which voxel of "darpa" (ICD 6.1) a cloud's points lie: cubes of one edge, of which one has its lower
/// corner at the origin. The cloud's own origin is applied (ICD 6.3.2).
class Voxels {
 public:
  /// So many voxels of each axis to either side of the origin are told apart.
  static constexpr std::int64_t kReach = 1 << 20;

  /// `edge`: in metres, above 0.
  Voxels(const icd::PointCloud2& cloud, double edge);

  /// Of a point of point_step bytes: its voxel. None where it is out of reach or not finite.
  VoxelBlock of(std::span<const std::uint8_t> point) const;

 private:
  CoordinateReader coordinates_;
  std::optional<icd::Placement> placement_;  // absent: the points are in "darpa"
  double per_metre_;
};

}  // namespace adit::pack
