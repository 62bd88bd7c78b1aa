#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"

namespace adit::codec {

/// For each byte of a little-endian point, the index of the big-endian byte. Swaps every value and leaves
/// padding. std::nullopt if two values overlap, because no swapped point preserves both. Requires
/// check(cloud).
std::optional<std::vector<std::uint32_t>> little_endian_order(const icd::PointCloud2& cloud);

/// Reorders the bytes of points; consumes `points` chunk by chunk. Bytes after the last whole point stay.
/// Requires an order that is not empty.
icd::ChunkedBytes in_order(icd::ChunkedBytes points, const std::vector<std::uint32_t>& order);

}  // namespace adit::codec
