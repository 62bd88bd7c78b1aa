#include "pack/taken_voxels.hpp"

#include <algorithm>
#include <utility>

#include "pack/points.hpp"

namespace adit::pack {
namespace {

/// Neighbours are often in one block.
void note(const VoxelBlock& found, std::vector<VoxelBlock>& all) {
  if (found.place == 0) return;
  if (all.empty() || all.back().place != found.place) all.push_back({found.place, 0});
  all.back().voxels |= found.voxels;
}

}  // namespace

TakenVoxels::Rest TakenVoxels::leave_out(const icd::RobotName& robot, const icd::PointCloud2& cloud,
                                         const icd::MapData& data, double edge) const {
  const auto found = robots_.find(robot);
  const bool knows = found != robots_.end() && found->second.edge == edge;
  const VoxelSet none, &taken = knows ? found->second.voxels : none;
  const Voxels voxels{cloud, edge};
  Rest rest;
  VoxelBlock block;  // of the point before, with all that was taken of it
  std::vector<bool> stays;
  stays.reserve(data.bytes.size() / cloud.point_step);
  for_each_point(data.bytes, cloud.point_step, [&](auto point) {
    const VoxelBlock at = voxels.of(point);
    if (at.place != block.place) block = {at.place, at.place == 0 ? 0 : taken.voxels_at(at.place)};
    stays.push_back((at.voxels & block.voxels) == 0);
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

/// For a block more of that robot's.
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
