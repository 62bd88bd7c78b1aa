#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::picture {

/// The drawn world: the frame "darpa" from above, x to the right and y up, in tiles of kSide x kSide pixels
/// at kLevels scales. Level 0 is the base. Each further level is coarser by kStep.
inline constexpr int kSide = 256;
inline constexpr int kStep = 4;
inline constexpr int kLevels = 3;
inline constexpr std::array<double, kLevels> kMetresPerPixel{0.25, 1, 4};
inline constexpr double kPixel = kMetresPerPixel[0];

/// Finer levels, -1 and -2, are drawn on request only: see fine.hpp. Each is finer by kFineStep, so that the
/// cells of most grids (5, 10, 20, 25 cm) are whole pixels.
inline constexpr int kFineStep = 5;
inline constexpr int kFinest = -2;
inline constexpr std::array<double, 2> kFineMetresPerPixel{0.05, 0.01};
inline constexpr double metres_per_pixel(int level) {
  return level < 0 ? kFineMetresPerPixel[static_cast<std::size_t>(-1 - level)]
                   : kMetresPerPixel[static_cast<std::size_t>(level)];
}

/// The drawn world's reach from the frame's origin along x and y: in metres, pixels and tiles of the base.
inline constexpr double kWorldMetres = 8192;
inline constexpr int kWorldPixels = 32768;
inline constexpr int kWorldTiles = kWorldPixels / kSide;

/// The numbers are in files and must not change.
enum class LayerKind : std::uint8_t { Grid = 0, Cloud = 1 };

/// One robot's maps of one kind; "" is the merged map.
struct Layer {
  std::string robot;
  LayerKind kind = LayerKind::Grid;
  friend auto operator<=>(const Layer&, const Layer&) = default;
};

inline Layer layer_of(const icd::MapUpdate& map) {
  return {icd::text_of(map.name), map.is_grid() ? LayerKind::Grid : LayerKind::Cloud};
}

/// The tile that covers x to x + 1 and y to y + 1, in units of kSide pixels of its level.
struct TileIndex {
  int level = 0, x = 0, y = 0;
  friend auto operator<=>(const TileIndex&, const TileIndex&) = default;
};

/// The tile of the next coarser level that contains this one.
inline TileIndex coarser(const TileIndex& at) {
  const int step = at.level < 0 ? kFineStep : kStep;
  const auto down = [step](int number) { return (number - (number < 0 ? step - 1 : 0)) / step; };
  return {at.level + 1, down(at.x), down(at.y)};
}

/// True if a part of it lies in the drawn world.
inline bool is_in_world(const TileIndex& at) {
  if (at.level < kFinest || at.level >= kLevels) return false;
  const double reach = kWorldMetres / (metres_per_pixel(at.level) * kSide);
  const auto inside = [reach](int number) { return number >= -reach && number < reach; };
  return inside(at.x) && inside(at.y);
}

/// A rectangle, in metres.
struct Area {
  double left = 0, bottom = 0, right = 0, top = 0;
  friend bool operator==(const Area&, const Area&) = default;
};

/// True if they have more than a border in common.
inline bool touch(const Area& a, const Area& b) {
  return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

inline Area area_of(const TileIndex& at) {
  const double metres = metres_per_pixel(at.level) * kSide;
  return {at.x * metres, at.y * metres, (at.x + 1) * metres, (at.y + 1) * metres};
}

inline void extend(std::optional<Area>& area, const Area& more) {
  if (!area) {
    area = more;
    return;
  }
  area->left = std::min(area->left, more.left);
  area->bottom = std::min(area->bottom, more.bottom);
  area->right = std::max(area->right, more.right);
  area->top = std::max(area->top, more.top);
}

/// The colour index of each pixel of a tile, row by row from the top as in a PNG. 0: unknown.
using Pixels = std::array<std::uint8_t, kSide * kSide>;

/// Index of a pixel in Pixels. x to the right, y up.
inline constexpr std::size_t index_of(int x, int y) {
  return static_cast<std::size_t>(kSide - 1 - y) * kSide + static_cast<std::size_t>(x);
}

/// A tile as stored: a PNG's IDAT chunk (a zlib stream of unfiltered rows) without the shared palette.
struct PackedTile {
  std::vector<std::uint8_t> deflated;
  std::uint32_t crc = 0;  // of the chunk, by PNG 5.5; equal tiles have equal values
};
using Tile = std::shared_ptr<const PackedTile>;  // null: blank

/// Packs many tiles with one zlib stream, because creating a stream is expensive. For one thread.
class Packer {
 public:
  Packer();
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  Tile pack(const Pixels& pixels);
  void unpack(const PackedTile& packed, Pixels& pixels);
  /// False if a tile read from disk is damaged.
  bool is_whole(const PackedTile& packed);

 private:
  struct Streams;
  /// Inflates into rows_. False: not one whole tile.
  bool read_rows(const PackedTile& packed);

  std::unique_ptr<Streams> streams_;
  std::vector<std::uint8_t> rows_, made_;
};

}  // namespace adit::picture
