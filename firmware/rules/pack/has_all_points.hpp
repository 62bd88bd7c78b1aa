#pragma once

#include <cstddef>

#include "icd/mapping.hpp"

namespace adit::pack {

/// Clouds of so many points are compared from the beginning only, which bounds others' memory to 32 MiB.
inline constexpr std::size_t kMostComparedPoints = std::size_t{1} << 20;

/// True if `newer` has each point of `older`, with equal bytes: at its beginning in the same order, as in a
/// cloud that grows, or anywhere in any order. Points are uncompressed and have point_step bytes. False if
/// the points are too many to compare, or if `newer` has fewer points (also if `older` has duplicates).
/// Points with equal 62-bit hashes count as equal. The time grows with both sizes, so call it on a worker.
bool has_all_points(const icd::MapData& newer, const icd::MapData& older, std::size_t point_step);

}  // namespace adit::pack
