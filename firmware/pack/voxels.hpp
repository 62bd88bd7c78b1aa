#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "icd/map_update.hpp"
#include "icd/placement.hpp"
#include "pack/coordinates.hpp"

namespace adit::pack {

/// Some voxels of one block of 4 x 4 x 4 voxels.
struct VoxelBlock {
  std::uint64_t place = 0;   // of the block; 0: no block
  std::uint64_t voxels = 0;  // one bit for each voxel
  friend bool operator==(const VoxelBlock&, const VoxelBlock&) = default;
};

/// Finds the voxel of "darpa" (ICD 6.1) in which a point of the cloud lies. Voxels are cubes; one has its
/// lower corner at the origin of "darpa". The cloud's own origin is applied (ICD 6.3.2).
class Voxels {
 public:
  /// Voxels reach this far from the origin along each axis.
  static constexpr std::int64_t kReach = 1 << 20;

  /// `edge`: metres, > 0.
  Voxels(const icd::PointCloud2& cloud, double edge);

  /// The voxel of a point of point_step bytes. A block with place 0 if it is out of reach or not finite.
  VoxelBlock of(std::span<const std::uint8_t> point) const;

 private:
  CoordinateReader coordinates_;
  std::optional<icd::Placement> placement_;  // absent: the points are in "darpa"
  double per_metre_;
};

}  // namespace adit::pack
