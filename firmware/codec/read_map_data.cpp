#include "codec/read_map_data.hpp"

#include "codec/gzip.hpp"
#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

constexpr std::string_view kPath = "msg.data";

/// Checks cells as they pass, on their way into the gzip member that goes upstream.
class CellPress {
 public:
  explicit CellPress(const icd::OccupancyGrid& grid) : grid_(grid) {}

  icd::Checked<void> take(std::span<const std::uint8_t> cells) {
    const std::size_t expected = icd::cells_of(grid_);
    if (cells.size() > expected - taken_) {  // at once: a gzip bomb is not worth inflating further
      return icd::unprocessable("msg.info.width: expected ", grid_.width, " x ", grid_.height, " = ",
                                expected, " bytes of data, got more");
    }
    if (auto checked = icd::check_cells(cells, taken_); !checked) return checked;
    gzipper_.feed(cells);
    taken_ += cells.size();
    return {};
  }

  icd::Checked<icd::MapData> finish() {
    if (auto checked = icd::check_size(grid_, taken_); !checked) return std::unexpected(checked.error());
    return icd::MapData{
        .bytes = gzipper_.finish(), .compression = icd::Compression::Gzip, .raw_size = taken_};
  }

 private:
  const icd::OccupancyGrid& grid_;
  Gzipper gzipper_{GzipStrategy::Runs};
  std::size_t taken_ = 0;
};

}  // namespace

icd::Checked<icd::MapData> read_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                      icd::Compression compression, const icd::Rules& rules) {
  CellPress press(grid);
  if (compression == icd::Compression::Gzip) {
    const auto sink = [&](std::span<const std::uint8_t> cells) { return press.take(cells); };
    const auto inflated = gunzip(std::move(data), rules.map_bytes, kPath, sink);
    if (!inflated) return std::unexpected(inflated.error());
    return press.finish();
  }
  if (auto checked = icd::check_size(grid, data.size()); !checked) return std::unexpected(checked.error());
  while (!data.empty()) {
    if (auto taken = press.take(*data.pop_front()); !taken) return std::unexpected(taken.error());
  }
  return press.finish();
}

icd::Checked<icd::MapData> read_points(const icd::PointCloud2& cloud, icd::ChunkedBytes data,
                                       icd::Compression compression, const icd::Rules& rules) {
  icd::ChunkedBytes points;
  if (compression == icd::Compression::Gzip) {
    const auto sink = [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
      points.append(piece);
      return {};
    };
    const auto inflated = gunzip(std::move(data), rules.map_bytes, kPath, sink);
    if (!inflated) return std::unexpected(inflated.error());
  } else {
    points = std::move(data);
  }
  if (points.size() > rules.map_bytes) {
    return icd::unprocessable(kPath, ": expected at most ", rules.map_bytes,
                              " bytes (the setting rules.map_bytes), got ", points.size());
  }
  if (auto checked = icd::check_size(cloud, points.size()); !checked) return std::unexpected(checked.error());
  const std::size_t size = points.size();
  return icd::MapData{.bytes = std::move(points), .compression = icd::Compression::None, .raw_size = size};
}

}  // namespace adit::codec
