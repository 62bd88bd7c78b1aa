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
