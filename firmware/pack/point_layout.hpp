#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "icd/map_update.hpp"

namespace adit::pack {

/// How a cloud's points lie in memory, and how they are made of others that lie otherwise.
struct PointLayout {
  /// Bytes of a point that go together.
  struct Run {
    std::uint32_t from = 0, to = 0, size = 0;
  };

  icd::PointCloud2 cloud;
  std::vector<Run> runs;  // of the other points, each byte of these

  /// Copies a point of the old layout to one of the new.
  void copy(std::span<const std::uint8_t> point, std::span<std::uint8_t> to) const;
};

/// As it is: each point is copied whole.
PointLayout unchanged(const icd::PointCloud2& cloud);

/// Without the padding between and after the fields: these have other offsets, and the cloud another
/// point_step. They keep their place in the list, stand in a point in the same order, and no byte of them
/// changes. Nothing where two fields share a byte. Requires check(cloud).
std::optional<PointLayout> without_padding(const icd::PointCloud2& cloud);

}  // namespace adit::pack
