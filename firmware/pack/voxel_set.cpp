#include "pack/voxel_set.hpp"

#include <bit>
#include <utility>

namespace adit::pack {
namespace {

constexpr std::size_t kFewest = 1024;  // places

}  // namespace

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

}  // namespace adit::pack
