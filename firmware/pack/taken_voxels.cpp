#include "pack/taken_voxels.hpp"

#include <algorithm>
#include <utility>

#include "pack/points.hpp"

namespace adit::pack {
namespace {

/// Merges a voxel into the last block, because neighbours often share one.
void note(const VoxelBlock& found, std::vector<VoxelBlock>& all) {
  if (found.place == 0) return;
  if (all.empty() || all.back().place != found.place) all.push_back({found.place, 0});
  all.back().voxels |= found.voxels;
}

/// The voxels that have a point already, accepted or in this message.
class Held {
 public:
  explicit Held(const VoxelSet& taken) : taken_(taken) {}

  /// True if this is the first point of its voxel, or has no voxel. Notes the voxel.
  bool is_first(const VoxelBlock& at) {
    if (at.place == 0) return true;
    if (at.place != here_.place) go_to(at.place);
    if ((at.voxels & here_.voxels) != 0) return false;
    here_.voxels |= at.voxels;
    return true;
  }

 private:
  void go_to(std::uint64_t place) {
    if (here_.place != 0) left_.add(here_);
    here_ = {place, taken_.voxels_at(place) | left_.voxels_at(place)};
  }

  const VoxelSet& taken_;
  VoxelSet left_;    // blocks left behind, with this message's points
  VoxelBlock here_;  // the block of the previous point
};

}  // namespace

TakenVoxels::Rest TakenVoxels::leave_out(const icd::RobotName& robot, const icd::PointCloud2& cloud,
                                         const icd::MapData& data, double edge) const {
  const auto found = robots_.find(robot);
  const bool knows = found != robots_.end() && found->second.edge == edge;
  const VoxelSet none, &taken = knows ? found->second.voxels : none;
  const Voxels voxels{cloud, edge};
  Rest rest;
  Held held{taken};
  std::vector<bool> stays;
  stays.reserve(data.bytes.size() / cloud.point_step);
  for_each_point(data.bytes, cloud.point_step, [&](auto point) {
    const VoxelBlock at = voxels.of(point);
    stays.push_back(held.is_first(at));
    if (stays.back()) note(at, rest.voxels);
    return true;
  });
  rest.left_out = static_cast<std::size_t>(std::ranges::count(stays, false));
  const auto next_stays = [next = stays.begin()](auto) mutable { return bool{*next++}; };
  rest.data = rest.left_out == 0 ? data : those_that_stay(data, cloud.point_step, next_stays);
  return rest;
}

void TakenVoxels::add(const icd::RobotName& robot, double edge, std::span<const VoxelBlock> voxels) {
  Robot& its = robots_[robot];
  if (its.edge != edge) its = {.edge = edge, .last = 0, .voxels = {}};
  its.last = ++adds_;
  for (const VoxelBlock& block : voxels) {
    if (its.voxels.bytes_with_another() > its.voxels.bytes()) make_room(its);
    its.voxels.add(block);
  }
}

/// Makes room for one more block of that robot.
void TakenVoxels::make_room(Robot& robot) {
  while (bytes() - robot.voxels.bytes() + robot.voxels.bytes_with_another() > most_bytes_) {
    const auto oldest =
        std::ranges::min_element(robots_, {}, [](const auto& each) { return each.second.last; });
    if (&oldest->second == &robot) {
      robot.voxels = {};
      return;
    }
    robots_.erase(oldest);
  }
}

std::size_t TakenVoxels::bytes() const {
  std::size_t bytes = 0;
  for (const auto& [name, robot] : robots_) bytes += robot.voxels.bytes();
  return bytes;
}

}  // namespace adit::pack
