#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/robot_name.hpp"
#include "pack/voxel_set.hpp"
#include "pack/voxels.hpp"

namespace adit::pack {

/// The voxels in which the Command Post has taken a point, of each robot's clouds, so that another point of
/// the same voxel need not be sent.
///
/// What it holds is bounded over all robots, but while a set grows, half of that more. Beyond it, the voxels
/// of the robot are forgotten whose clouds were taken longest ago, and at last those of the robot itself:
/// then its points are sent again, and nothing is lost by it. What it does takes CPU time in proportion to
/// the points: meant for a worker.
class TakenVoxels {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{32} << 20;
  explicit TakenVoxels(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  /// A cloud without the points that need not be sent.
  struct Rest {
    icd::MapData data;
    std::vector<VoxelBlock> voxels;  // of its points, to be given to add() once it was taken
    std::size_t left_out = 0;        // points
  };
  /// `data`: the cloud's, not compressed. Of its points those are left out whose voxel (`edge` metres) has a
  /// point that was taken from this robot, or one before it in the cloud. The others are kept, in their order
  /// and byte for byte; so are those of no voxel.
  Rest leave_out(const icd::RobotName& robot, const icd::PointCloud2& cloud, const icd::MapData& data,
                 double edge) const;

  /// The Command Post took points in these voxels. A robot's of another edge are forgotten.
  void add(const icd::RobotName& robot, double edge, std::span<const VoxelBlock> voxels);
  void forget() { robots_.clear(); }
  std::size_t bytes() const;

 private:
  struct Robot {
    double edge = 0;
    std::uint64_t last = 0;  // by the count of adds_
    VoxelSet voxels;
  };
  void make_room(Robot& robot);

  std::size_t most_bytes_;
  std::uint64_t adds_ = 0;
  std::map<icd::RobotName, Robot> robots_;
};

}  // namespace adit::pack
