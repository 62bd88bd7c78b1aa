#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "icd/map_update.hpp"

namespace adit::pack {

/// The layout of a cloud's points, and how to copy points of another layout into it.
struct PointLayout {
  /// Adjacent bytes of a point that are copied together.
  struct Run {
    std::uint32_t from = 0, to = 0, size = 0;
  };

  icd::PointCloud2 cloud;
  std::vector<Run> runs;  // they cover each byte that is kept

  /// Copies a point from the old layout to the new one.
  void copy(std::span<const std::uint8_t> point, std::span<std::uint8_t> to) const;
};

/// The layout of `cloud`; each point is copied whole.
PointLayout unchanged(const icd::PointCloud2& cloud);

/// The layout without the padding between and after the fields. Offsets and point_step change. The fields
/// keep their bytes, their places in the list, and their order in a point. nullopt if two fields share a
/// byte. Requires check(cloud).
std::optional<PointLayout> without_padding(const icd::PointCloud2& cloud);

}  // namespace adit::pack
