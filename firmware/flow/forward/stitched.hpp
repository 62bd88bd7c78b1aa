#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "icd/mapping.hpp"
#include "icd/robot_name.hpp"
#include "icd/status.hpp"
#include "pack/pack.hpp"
#include "pack/taken_voxels.hpp"
#include "queues/clouds.hpp"
#include "queues/lattice.hpp"
#include "queues/map_queue.hpp"

namespace adit::forward {

/// What packing left out of a cloud, to be recorded on delivery.
struct LeftOut {
  std::size_t points = 0;
  bool is_all = false;                   // no point remains
  std::uint64_t epoch = 0;               // of DeliveredPoints when the points were left out
  double edge = 0;                       // of a voxel, metres; 0: the robot's clouds are sent whole
  std::vector<pack::VoxelBlock> voxels;  // of sent points
  std::optional<icd::MapUpdate> sent;    // if points were left out
};

/// A worker's task: leaves points out of clouds, one cloud at a time.
class LeavingOut {
 public:
  /// A delivered cloud.
  struct Taken {
    icd::RobotName robot;
    double edge = 0;
    std::vector<pack::VoxelBlock> voxels;
  };
  /// For one thread at a time.
  struct Known {
    std::uint64_t epoch = 0;
    pack::TakenVoxels voxels;
  };

  LeavingOut() = default;
  LeavingOut(std::shared_ptr<Known> known, std::uint64_t epoch, double edge, std::vector<Taken> taken)
      : known_(std::move(known)), epoch_(epoch), edge_(edge), taken_(std::move(taken)) {}

  /// Removes points from `map`, which is not packed yet. Call on the worker.
  LeftOut operator()(icd::MapUpdate& map);

 private:
  std::shared_ptr<Known> known_;  // null: leaves nothing out
  std::uint64_t epoch_ = 0;
  double edge_ = 0;
  std::vector<Taken> taken_;  // since the last cloud
};

/// Points at the Command Post, whose voxels need no others (robots[].voxel_metres). On the loop; the packing
/// worker owns the voxels.
///
/// A cloud reduced in an earlier epoch must be sent whole, because the Command Post may lack the points.
class DeliveredPoints {
 public:
  /// Metres, per robot. A change forgets all points.
  void edges_are(std::map<icd::RobotName, double> edges);
  /// The Command Post may have lost its points: begins a new epoch.
  void forget();

  /// For the next map to pack; only one at a time.
  LeavingOut leaving_out(const icd::MapUpdate& map);
  /// True if the points left out are still at the Command Post.
  bool hold(const LeftOut& left_out) const { return left_out.points == 0 || left_out.epoch == epoch_; }
  /// The Command Post accepted the rest of this cloud.
  void taken(const icd::MapUpdate& map, LeftOut left_out);

 private:
  std::map<icd::RobotName, double> edges_;
  std::uint64_t epoch_ = 1;
  std::shared_ptr<LeavingOut::Known> known_;  // null before the first edge
  std::vector<LeavingOut::Taken> taken_;      // new to the worker
};

/// A map in its form for the Command Post.
struct Packed {
  icd::ChunkedBytes body;  // empty: all points left out, or the data of a part is damaged
  icd::MapData stitched;   // cells from its parts
  LeftOut left_out;
  queues::Precision precision = queues::Precision::Exact;  // a cloud's rounding
  std::size_t points_size = 0;                             // sent points, unpacked
  std::size_t full_size = 0;                               // the same, packed by Effort::Full or as estimated
  pack::Effort effort = pack::Effort::Full;
  double expected = 0;  // packing seconds (pack::seconds_for)
  /// `ground` with the map drawn over it; nullopt: not wanted, or damaged.
  std::optional<queues::Ground> drawn;
};

struct Packing {
  bool arranges_clouds = true;
  /// Decides the effort for grids and for clouds that are not rounded.
  pack::Hurry hurry{};
};

/// Rounds a cloud to waiting.precision, or keeps it exact if that is impossible. A map that goes as it is
/// (queues::PackingRule) only loses invalid points. CPU-bound: call on a worker.
Packed packed(const queues::QueuedMap& waiting, LeavingOut leaving_out = {}, const Packing& packing = {});

/// The map with its cells, stitched from its parts over the ground if necessary, or with the points or
/// rows that are sent next. An error describes the fault in the data.
icd::Checked<icd::MapUpdate> whole_of(const queues::QueuedMap& waiting);

}  // namespace adit::forward
