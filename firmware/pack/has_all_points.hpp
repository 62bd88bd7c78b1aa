#pragma once

#include <cstddef>

#include "icd/map_update.hpp"

namespace adit::pack {

/// Beyond it clouds are compared from their beginning on alone: it bounds the memory for others to 16 MiB.
inline constexpr std::size_t kMostComparedPoints = std::size_t{1} << 20;

/// Whether `newer` has each point of `older`, all its bytes alike: in `older`'s order from the beginning, as
/// a cloud that is added to, or in any order. Points of point_step bytes, not compressed. False where there
/// are too many to tell, or fewer in `newer`, also where `older` has one twice. Two points are taken for one
/// where hashes of 62 bits agree. CPU-bound in the size of both: meant for a worker.
bool has_all_points(const icd::MapData& newer, const icd::MapData& older, std::size_t point_step);

}  // namespace adit::pack
