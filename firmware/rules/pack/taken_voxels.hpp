#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "icd/geometry.hpp"
#include "icd/mapping.hpp"
#include "icd/robot_name.hpp"
#include "pack/points.hpp"

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

/// Voxels by block: open addressing, at most three quarters full.
class VoxelSet {
 public:
  /// The voxels of the block at `place`; 0 if there is none.
  std::uint64_t voxels_at(std::uint64_t place) const;
  /// The set is unchanged if this throws std::bad_alloc.
  void add(const VoxelBlock& block);

  /// Memory now, and after another block is added.
  std::size_t bytes() const { return places_.size() * sizeof(VoxelBlock); }
  std::size_t bytes_with_another() const { return places_with_another() * sizeof(VoxelBlock); }

 private:
  std::size_t place_of(std::uint64_t place) const;
  std::size_t places_with_another() const;
  void grow(std::size_t places);

  std::vector<VoxelBlock> places_;  // empty, or a power of two
  std::size_t count_ = 0;
};

/// For each robot, the voxels in which the Command Post has accepted a point. Another point of such a voxel
/// need not be sent.
///
/// The memory for all robots is at most `most_bytes`, and half as much more while a set grows. Beyond that,
/// the robot whose clouds were accepted longest ago is forgotten, and finally the growing robot's own voxels.
/// Their points are then sent again, so nothing is lost. The time grows with the points, so call it on a
/// worker.
class TakenVoxels {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{32} << 20;
  explicit TakenVoxels(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  /// A cloud without the points that need not be sent.
  struct Rest {
    icd::MapData data;
    std::vector<VoxelBlock> voxels;  // of its points; pass them to add() once it is accepted
    std::size_t left_out = 0;        // number of points
  };
  /// Leaves out each point of uncompressed `data` whose voxel (`edge` metres) has an accepted point of this
  /// robot or an earlier point of this cloud. The other points keep their order and bytes. Points without a
  /// voxel are kept.
  Rest leave_out(const icd::RobotName& robot, const icd::PointCloud2& cloud, const icd::MapData& data,
                 double edge) const;

  /// The Command Post accepted points in these voxels. Forgets the robot's voxels if `edge` has changed.
  void add(const icd::RobotName& robot, double edge, std::span<const VoxelBlock> voxels);
  void forget() { robots_.clear(); }
  std::size_t bytes() const;

 private:
  struct Robot {
    double edge = 0;
    std::uint64_t last = 0;  // the number of its last add()
    VoxelSet voxels;
  };
  void make_room(Robot& robot);

  std::size_t most_bytes_;
  std::uint64_t adds_ = 0;
  std::map<icd::RobotName, Robot> robots_;
};

}  // namespace adit::pack
