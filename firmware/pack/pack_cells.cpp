#include "pack/pack_cells.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "codec/gzip_whole.hpp"
#include "codec/map_pieces.hpp"
#include "pack/deflate_symbols.hpp"
#include "pack/grid_gzipper.hpp"

namespace adit::pack {
namespace {

/// A grid that is smaller is given to libdeflate at once.
constexpr std::size_t kFewCells = std::size_t{64} * 1024;
/// Of a grid that repeats itself from row to row a byte holds more cells. Measured: 35 to 220, and 2 to 20
/// where it does not.
constexpr std::size_t kCellsPerByte = 40;

using Cells = std::vector<std::uint8_t>;

/// More are not whole in memory, unless they are for libdeflate.
constexpr std::size_t kManyCells = std::size_t{16} << 20, kMostCells = std::size_t{40} << 20;

/// Nothing where they are damaged.
std::optional<Cells> whole(const icd::MapData& data) {
  if (data.compression == icd::Compression::None) return data.bytes.to_vector();
  return codec::gunzip_whole(data.bytes, data.raw_size);
}

icd::ChunkedBytes by_rows(const icd::OccupancyGrid& grid, std::span<const std::uint8_t> cells) {
  GridGzipper gzipper(grid.width);
  gzipper.feed(cells);
  return gzipper.finish();
}

std::optional<icd::ChunkedBytes> piece_by_piece(const icd::OccupancyGrid& grid, const icd::MapData& data) {
  GridGzipper gzipper(grid.width);
  const auto read =
      codec::for_each_piece(data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
        gzipper.feed(piece);
        return {};
      });
  if (!read) return std::nullopt;
  return gzipper.finish();
}

/// Whether a row can be compared with the one before.
bool has_rows(const icd::OccupancyGrid& grid) {
  return grid.width > 1 && grid.height > 1 && grid.width <= kMostDistance;
}

bool may_repeat_elsewhere(const icd::OccupancyGrid& grid, std::size_t cells, std::size_t packed) {
  return !has_rows(grid) || cells <= kFewCells || packed > cells / kCellsPerByte;
}

/// By a part out of the middle, where a map begins: libdeflate's better levels are smaller than this one by a
/// tenth and more.
bool is_worth_libdeflate(const icd::OccupancyGrid& grid, std::span<const std::uint8_t> cells) {
  constexpr std::size_t kShare = 16, kMostProbed = std::size_t{512} * 1024;
  constexpr int kProbingLevel = 6;
  if (!has_rows(grid) || cells.size() <= kFewCells) return true;
  const std::size_t size = std::clamp(cells.size() / kShare, kFewCells, kMostProbed);
  const auto part = cells.subspan((cells.size() - size) / 2, size);
  const std::size_t ours = by_rows(grid, part).size();
  return codec::gzip_whole(part, kProbingLevel, ours + ours / 20).has_value();
}

void take_smaller(icd::MapData& data, std::optional<icd::ChunkedBytes> member) {
  if (!member || member->size() >= data.bytes.size()) return;
  data.bytes = *std::move(member);
  data.compression = icd::Compression::Gzip;
}

}  // namespace

int level_for(std::size_t cells) {
  constexpr std::size_t kWithinASecond = 10'000'000;
  return cells <= kWithinASecond ? 9 : 6;
}

icd::MapData pack_cells(const icd::OccupancyGrid& grid, icd::MapData data) {
  auto cells = data.raw_size <= kManyCells ? whole(data) : std::nullopt;
  auto member = cells ? std::optional(by_rows(grid, *cells)) : piece_by_piece(grid, data);
  if (!member) return data;
  icd::MapData smallest = data;
  take_smaller(smallest, std::move(member));
  if (!may_repeat_elsewhere(grid, data.raw_size, smallest.bytes.size())) return smallest;
  if (!cells && data.raw_size <= kMostCells) cells = whole(data);
  if (!cells) return smallest;
  if (is_worth_libdeflate(grid, *cells)) {
    take_smaller(smallest, codec::gzip_whole(*cells, level_for(cells->size()), smallest.bytes.size()));
  }
  if (cells->size() > smallest.bytes.size()) return smallest;
  return {icd::ChunkedBytes(*cells), icd::Compression::None, cells->size()};
}

}  // namespace adit::pack
