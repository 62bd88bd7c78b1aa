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
/// ICD 6.3.2: a whole number of points, left as they are.
icd::Checked<icd::MapData> read_points(const icd::PointCloud2& cloud, icd::ChunkedBytes data,
                                       icd::Compression compression, const icd::Rules& rules);

}  // namespace adit::codec
