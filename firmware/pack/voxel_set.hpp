#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pack/voxels.hpp"

namespace adit::pack {

/// Voxels, each block of them in a place of its own: open addressing, at most three quarters full.
class VoxelSet {
 public:
  /// Those that it has of a block.
  std::uint64_t voxels_at(std::uint64_t place) const;
  /// Where there is no memory, it is as it was.
  void add(const VoxelBlock& block);

  /// Of memory; and what that is once another block has come.
  std::size_t bytes() const { return places_.size() * sizeof(VoxelBlock); }
  std::size_t bytes_with_another() const { return places_with_another() * sizeof(VoxelBlock); }

 private:
  std::size_t place_of(std::uint64_t place) const;
  std::size_t places_with_another() const;
  void grow(std::size_t places);

  std::vector<VoxelBlock> places_;  // a power of two of them, or none
  std::size_t count_ = 0;
};

}  // namespace adit::pack
