#include "pack/taken_voxels.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "pack/points.hpp"

namespace adit::pack {
namespace {

constexpr unsigned kBitsInBlock = 2;                        // of an index: the voxel within its block
constexpr unsigned kBitsOfBlock = 21 - kBitsInBlock;        // of an index: the block
constexpr std::uint64_t kIsThere = std::uint64_t{1} << 63;  // set in the place of each block

constexpr std::size_t kFewest = 1024;  // places

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

/// The index of the block, or of the free place for it. Fibonacci hashing (Knuth, The Art of Computer
/// Programming 3, 6.4).
std::size_t VoxelSet::place_of(std::uint64_t place) const {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;
  std::size_t at = (place * kGolden) >> (64 - std::countr_zero(places_.size()));
  while (places_[at].place != 0 && places_[at].place != place) at = (at + 1) & (places_.size() - 1);
  return at;
}

std::uint64_t VoxelSet::voxels_at(std::uint64_t place) const {
  return places_.empty() ? 0 : places_[place_of(place)].voxels;
}

void VoxelSet::add(const VoxelBlock& block) {
  if (places_.empty()) grow(kFewest);
  if (places_[place_of(block.place)].place == 0) {
    if (places_with_another() > places_.size()) grow(places_with_another());
    ++count_;
  }
  VoxelBlock& its = places_[place_of(block.place)];
  its.place = block.place;
  its.voxels |= block.voxels;
}

std::size_t VoxelSet::places_with_another() const {
  if (places_.empty()) return kFewest;
  return 4 * (count_ + 1) > 3 * places_.size() ? 2 * places_.size() : places_.size();
}

void VoxelSet::grow(std::size_t places) {
  const auto before = std::exchange(places_, std::vector<VoxelBlock>(places));
  for (const VoxelBlock& block : before) {
    if (block.place != 0) places_[place_of(block.place)] = block;
  }
}

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
