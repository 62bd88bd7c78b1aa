#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"
#include "icd/status.hpp"
#include "picture/tile.hpp"

namespace adit::picture {

/// A square of whole tiles of one level.
struct Frame {
  int level = 0;
  int left = -kWorldTiles, bottom = -kWorldTiles;  // its first tile
  int tiles = 2 * kWorldTiles;                     // along each side

  double metres_per_pixel() const { return picture::metres_per_pixel(level); }
  int first_x() const { return left * kSide; }  // pixels
  int first_y() const { return bottom * kSide; }
  int side() const { return tiles * kSide; }
};

/// One map within a frame, at the scale of its level. Each pixel has the highest index that falls on it. A
/// tile takes 64 KiB once a pixel in it is known, and there are at most kMostTiles.
class Sheet {
 public:
  static constexpr std::size_t kMostTiles = 512;  // about 2 square kilometres

  struct Part {
    TileIndex at;
    std::unique_ptr<Pixels> pixels;
  };

  /// By default: the whole world at the scale of the base.
  explicit Sheet(const Frame& frame = {});

  const Frame& frame() const { return frame_; }
  /// Raises a pixel of the frame to `index`. False if its tile would be one too many.
  bool raise(int x, int y, std::uint8_t index) {
    Pixels* pixels = tile(x >> 8, y >> 8);
    if (pixels == nullptr) return false;
    std::uint8_t& pixel = (*pixels)[index_of(x & (kSide - 1), y & (kSide - 1))];
    if (index > pixel) pixel = index;
    return true;
  }

  /// Raises a row of pixels from x, y on. The result is the number of known pixels without a tile.
  std::size_t raise(int x, int y, std::span<const std::uint8_t> row);

  std::span<const Part> parts() const { return parts_; }

 private:
  static_assert(kSide == 1 << 8);
  static constexpr std::uint16_t kNone = 0;

  /// Null if it would be one too many.
  Pixels* tile(int x, int y) {
    const auto at = static_cast<std::size_t>(y - frame_.bottom) * static_cast<std::size_t>(frame_.tiles) +
                    static_cast<std::size_t>(x - frame_.left);
    if (at != last_at_) {
      if (places_[at] == kNone) places_[at] = make_part(x, y);
      last_ = places_[at] == kNone ? nullptr : parts_[places_[at] - 1U].pixels.get();
      last_at_ = at;
    }
    return last_;
  }
  std::uint16_t make_part(int x, int y);

  Frame frame_;
  std::vector<Part> parts_;
  std::size_t last_at_ = SIZE_MAX;  // index of the last tile, because the next is often the same
  Pixels* last_ = nullptr;
  std::vector<std::uint16_t> places_;  // for each tile of the frame: its place in parts_ plus 1
};

/// The present tiles of a layer, to draw on. Tiles never change, so a worker may read them.
struct Canvas {
  std::uint64_t run = 0;            // the mosaic's run to which it belongs
  std::map<TileIndex, Tile> tiles;  // never null
};

/// Heights above z = 0 of "darpa", in metres.
struct Heights {
  double low = 0, high = 0;
  friend bool operator==(const Heights&, const Heights&) = default;
};

/// The changes that a map makes to the picture of its layer.
struct Drawing {
  Layer layer;
  std::uint64_t run = 0;                          // the canvas's
  std::vector<std::pair<TileIndex, Tile>> tiles;  // the changed tiles of all levels; never null
  std::optional<Area> area;                       // the known part of the map, to a pixel of the base
  std::optional<Heights> heights;  // of a cloud, without the lowest and highest hundredth of its pixels
  std::size_t left_out = 0;        // cells, points or pixels outside the world or over a limit below
};

/// Called repeatedly while a map is drawn: after each piece of its data, about 64 KB.
using Between = std::function<void()>;

/// Draws `map` on `before`, the canvas of layer_of(map). The time grows with the map, so call it on a worker.
///
/// A pixel shows the highest of all values that fall on it: the most occupied cell (occupied, free, unknown)
/// or the highest point. The known cells of a grid replace earlier ones; its unknown cells leave them. A
/// cloud only raises pixels. A pixel of a coarser level is the highest of its sixteen pixels.
///
/// Gzipped data is inflated piece by piece. An error says what is wrong with it.
icd::Checked<Drawing> draw(const icd::MapUpdate& map, const Canvas& before, const Between& between = [] {});

/// Limits of one drawing, in addition to Sheet::kMostTiles.
/// Points that are drawn. Of a larger cloud, only every second, third and so on is drawn.
inline constexpr std::size_t kMostPoints = std::size_t{4} << 20;
/// Cells in a row.
inline constexpr std::size_t kMostColumns = std::size_t{1} << 20;
/// Pixels that a turned grid sets, or without a tile in another; longest side of a turned cell, in pixels.
inline constexpr std::size_t kMostDabs = std::size_t{32} << 20;
inline constexpr double kLargestTurnedCell = 64;

/// Draw a map on an empty sheet. The result is the number of cells, points or pixels that were left out.
icd::Checked<std::size_t> draw_grid(const icd::OccupancyGrid& grid, const icd::MapData& data, Sheet& sheet,
                                    const Between& between);
icd::Checked<std::size_t> draw_cloud(const icd::PointCloud2& cloud, const icd::MapData& data, Sheet& sheet,
                                     const Between& between);

}  // namespace adit::picture
