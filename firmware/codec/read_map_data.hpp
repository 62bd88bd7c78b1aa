#pragma once

#include "codec/body_decoder.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"
#include "icd/rules.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// The data of a map whose other fields are checked, as it stood in the message under `compression`; consumed
/// chunk by chunk.

/// ICD 6.3.1: width * height cells, each 0 to 100 or 255, left as one gzip member.
icd::Checked<icd::MapData> read_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                      icd::Compression compression, const icd::Rules& rules);
/// The same of cells that were pressed as they arrived.
icd::Checked<icd::MapData> read_pressed_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                              icd::Compression compression, const PressedCells& pressed);

/// How ROS lays out an organised cloud, which the ICD does not say. All 0: the message does not say it
/// either.
struct CloudRows {
  std::uint64_t width = 0, height = 0;  // points in a row, and rows
  std::uint64_t row_step = 0;           // bytes from one row to the next
};
/// ICD 6.3.2: a whole number of points, left as they are, without the padding at the ends of rows. Real
/// drivers fill `rows` with anything (row_step 0, the size of all data, the number of points), so the rows
/// count only if they are padded and add up to the data.
icd::Checked<icd::MapData> read_points(const icd::PointCloud2& cloud, const CloudRows& rows,
                                       icd::ChunkedBytes data, icd::Compression compression,
                                       const icd::Rules& rules);

}  // namespace adit::codec
