#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pack/voxels.hpp"

namespace adit::pack {

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

}  // namespace adit::pack
