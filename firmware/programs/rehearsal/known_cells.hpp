#pragma once

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>

namespace adit {

/// The cells of grids that are known, each counted once however often it came: of what a robot posted, and of
/// what the Command Post has. Cells of another size are others. Both programs of this folder measure by it.
class KnownCells {
 public:
  static constexpr std::uint8_t kUnknown = 255;  // ICD 6.3.1

  /// A grid's cells, row by row from the lower left at (`left`, `bottom`), in metres as `resolution`; `width`
  /// is at least 1.
  void add(double resolution, double left, double bottom, std::size_t width,
           std::span<const std::uint8_t> cells) {
    const std::int64_t size = std::llround(resolution * 1e6);
    const std::int64_t first = std::llround(left / resolution);
    std::int64_t row = std::llround(bottom / resolution);
    for (; !cells.empty(); ++row) {
      const auto columns = cells.first(std::min(width, cells.size()));
      for (std::size_t x = 0; x < columns.size(); ++x) {
        if (columns[x] != kUnknown) include(size, first + static_cast<std::int64_t>(x), row);
      }
      cells = cells.subspan(columns.size());
    }
  }

  std::size_t count() const { return count_; }

 private:
  static constexpr std::int64_t kSide = 64;
  using Place = std::tuple<std::int64_t, std::int64_t, std::int64_t>;  // of a tile: cell size, column, row
  using Tile = std::bitset<kSide * kSide>;

  void include(std::int64_t size, std::int64_t column, std::int64_t row) {
    const Place place{size, column >> 6, row >> 6};
    if (last_ == nullptr || place != last_place_) {
      last_ = &tiles_[place];
      last_place_ = place;
    }
    auto cell = (*last_)[static_cast<std::size_t>((row & (kSide - 1)) * kSide + (column & (kSide - 1)))];
    count_ += cell ? 0 : 1;
    cell = true;
  }

  std::map<Place, Tile> tiles_;
  Place last_place_;
  Tile* last_ = nullptr;  // that of the cell before
  std::size_t count_ = 0;
};

}  // namespace adit
