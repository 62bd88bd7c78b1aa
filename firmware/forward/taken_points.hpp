#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/robot_name.hpp"
#include "pack/taken_voxels.hpp"

namespace adit::forward {

/// What was left out of a cloud that was packed, and what is to be told once it was taken.
struct LeftOut {
  std::size_t points = 0;
  bool is_all = false;      // nothing is left to be sent
  std::uint64_t epoch = 0;  // of TakenPoints, by which the points are there
  double edge = 0;          // of a voxel, in metres; 0: nothing is left out of this robot's clouds
  std::vector<pack::VoxelBlock> voxels;  // of the points that are not left out
  std::optional<icd::MapUpdate> sent;    // the cloud of these, as it goes upstream, where any are left out
};

/// What a worker leaves out of clouds, one after the other.
class LeavingOut {
 public:
  /// What the Command Post took of a cloud.
  struct Taken {
    icd::RobotName robot;
    double edge = 0;
    std::vector<pack::VoxelBlock> voxels;
  };
  /// The voxels themselves, which no other thread uses meanwhile.
  struct Known {
    std::uint64_t epoch = 0;
    pack::TakenVoxels voxels;
  };

  LeavingOut() = default;
  LeavingOut(std::shared_ptr<Known> known, std::uint64_t epoch, double edge, std::vector<Taken> taken)
      : known_(std::move(known)), epoch_(epoch), edge_(edge), taken_(std::move(taken)) {}

  /// Takes out of `map`, which is not packed yet, the points that need not be sent. For the worker.
  LeftOut operator()(icd::MapUpdate& map);

 private:
  std::shared_ptr<Known> known_;  // null: nothing is ever left out
  std::uint64_t epoch_ = 0;
  double edge_ = 0;
  std::vector<Taken> taken_;  // since the last cloud
};

/// Points that the Command Post has taken, so that others of their voxels need not be sent
/// (robots[].voxel_metres). On the loop; the voxels are the worker's that packs, for as long as it does.
///
/// What was left out by an epoch before must go: the Command Post of today may never have had it.
class TakenPoints {
 public:
  /// Of each robot that has any, in metres. Where they are others, all is forgotten.
  void edges_are(std::map<icd::RobotName, double> edges);
  /// The Command Post has nothing, or may have nothing, of what it took: a new epoch begins.
  void forget();

  /// For a map that is to be packed, while none other is.
  LeavingOut leaving_out(const icd::MapUpdate& map);
  /// Whether what was left out is still there.
  bool hold(const LeftOut& left_out) const { return left_out.points == 0 || left_out.epoch == epoch_; }
  /// The Command Post took what was left of this cloud.
  void taken(const icd::MapUpdate& map, LeftOut left_out);

 private:
  std::map<icd::RobotName, double> edges_;
  std::uint64_t epoch_ = 1;
  std::shared_ptr<LeavingOut::Known> known_;  // null: no robot has had an edge
  std::vector<LeavingOut::Taken> taken_;      // that the worker does not know of
};

}  // namespace adit::forward
