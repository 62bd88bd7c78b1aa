#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/mapping.hpp"
#include "icd/rules.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// For each byte of a little-endian point, the index of the big-endian byte. Swaps every value and leaves
/// padding. std::nullopt if two values overlap, because no swapped point preserves both. Requires
/// check(cloud).
std::optional<std::vector<std::uint32_t>> little_endian_order(const icd::PointCloud2& cloud);

/// Reorders the bytes of points; consumes `points` chunk by chunk. Bytes after the last whole point stay.
/// Requires an order that is not empty.
icd::ChunkedBytes in_order(icd::ChunkedBytes points, const std::vector<std::uint32_t>& order);

// These read a map's data in the message's `compression`, after the other fields were checked, and consume it
// chunk by chunk.

/// ICD 6.3.1: width * height cells, each 0 to 100 or 255, left as one gzip member.
icd::Checked<icd::MapData> read_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                      icd::Compression compression, const icd::Rules& rules);
/// The same for cells compressed on arrival.
icd::Checked<icd::MapData> read_pressed_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                              icd::Compression compression, const PressedCells& pressed);

/// ROS's layout of an organised cloud, which the ICD does not have. All 0: not in the message.
struct CloudRows {
  std::uint64_t width = 0, height = 0;  // points in a row, and number of rows
  std::uint64_t row_step = 0;           // bytes from row to row
};
/// ICD 6.3.2: a whole number of points, unchanged, without padding at row ends. Drivers fill `rows` with
/// wrong values (row_step 0, the size of all data, the number of points), so rows count only if they are
/// padded and match the size of the data.
icd::Checked<icd::MapData> read_points(const icd::PointCloud2& cloud, const CloudRows& rows,
                                       icd::ChunkedBytes data, icd::Compression compression,
                                       const icd::Rules& rules);

}  // namespace adit::codec
