#include "pack/stitch.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "codec/gzip.hpp"
#include "icd/require.hpp"
#include "icd/try.hpp"

namespace adit::pack {
namespace {

/// Copies a tile's cells, piece by piece, to their places in rows of `width` cells.
class TileCopier {
 public:
  TileCopier(std::vector<std::uint8_t>& cells, std::size_t width, const Tile& tile)
      : cells_(cells), width_(width), tile_(tile) {}

  void feed(std::span<const std::uint8_t> piece) {
    while (!piece.empty()) {
      const std::size_t row = laid_ / tile_.width, column = laid_ % tile_.width;
      const auto run = piece.first(std::min(piece.size(), tile_.width - column));
      const std::size_t place = (tile_.row + row) * width_ + tile_.column + column;
      icd::require(row < tile_.height && place + run.size() <= cells_.size());
      std::ranges::copy(run, cells_.begin() + static_cast<std::ptrdiff_t>(place));
      laid_ += run.size();
      piece = piece.subspan(run.size());
    }
  }

 private:
  std::vector<std::uint8_t>& cells_;
  std::size_t width_;
  const Tile& tile_;
  std::size_t laid_ = 0;
};

}  // namespace

icd::Checked<icd::MapData> stitch(std::size_t width, std::size_t height, std::span<const Tile> tiles,
                                  std::vector<std::uint8_t> under) {
  if (under.empty()) under.assign(width * height, icd::kUnknownCell);
  icd::require(under.size() == width * height);
  const auto cells = std::make_shared<std::vector<std::uint8_t>>(std::move(under));
  for (const Tile& tile : tiles) {
    icd::require(tile.column + tile.width <= width && tile.row + tile.height <= height);
    TileCopier laying{*cells, width, tile};
    const auto laid =
        codec::for_each_piece(tile.data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
          laying.feed(piece);
          return {};
        });
    if (!laid) return std::unexpected(laid.error());
  }
  icd::MapData data{{}, icd::Compression::None, cells->size()};
  data.bytes.append(cells, *cells);
  return data;
}

icd::Checked<void> cut(const icd::MapData& cells, std::size_t width, std::span<Tile> tiles) {
  for (Tile& tile : tiles) tile.data = {{}, icd::Compression::None, tile.width * tile.height};
  std::size_t at = 0;
  const auto put_row = [&](std::size_t row, std::size_t column, std::span<const std::uint8_t> run) {
    for (Tile& tile : tiles) {
      if (row < tile.row || row >= tile.row + tile.height) continue;
      const std::size_t from = std::max(column, tile.column);
      const std::size_t to = std::min(column + run.size(), tile.column + tile.width);
      if (from < to) tile.data.bytes.append(run.subspan(from - column, to - from));
    }
  };
  ADIT_TRY(codec::for_each_piece(cells, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
    while (!piece.empty()) {
      const std::size_t row = at / width, column = at % width;
      const auto run = piece.first(std::min(piece.size(), width - column));
      put_row(row, column, run);
      at += run.size();
      piece = piece.subspan(run.size());
    }
    return {};
  }));
  for (Tile& tile : tiles) {
    tile.data.bytes = codec::gzip(std::move(tile.data.bytes), codec::GzipStrategy::Runs);
    tile.data.compression = icd::Compression::Gzip;
  }
  return {};
}

}  // namespace adit::pack
