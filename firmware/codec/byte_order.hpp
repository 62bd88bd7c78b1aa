#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"

namespace adit::codec {

/// For each byte of a little-endian point, which byte of the big-endian one it is: every value turned,
/// padding left where it is. Nothing where two values lie across each other, so that no turned point says
/// what both said. Requires check(cloud).
std::optional<std::vector<std::uint32_t>> little_endian_order(const icd::PointCloud2& cloud);

/// Points with their bytes in that order; consumes `points` chunk by chunk. What follows the last whole point
/// stays as it is. Requires an order.
icd::ChunkedBytes in_order(icd::ChunkedBytes points, const std::vector<std::uint32_t>& order);

}  // namespace adit::codec
