#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>

#include "icd/map_update.hpp"

namespace adit::picture {

/// The world as it is drawn: the frame "darpa" from above, x to the right and y up, in tiles of kSide x kSide
/// pixels at kLevels scales. Level 0 is the base; each further one is coarser by kStep.
inline constexpr int kSide = 256;
inline constexpr int kStep = 4;
inline constexpr int kLevels = 3;
inline constexpr std::array<double, kLevels> kMetresPerPixel{0.25, 1, 4};
inline constexpr double kPixel = kMetresPerPixel[0];

/// What lies farther from the frame's origin along x or y is not drawn: in metres, pixels and tiles of the
/// base.
inline constexpr double kWorldMetres = 8192;
inline constexpr int kWorldPixels = 32768;
inline constexpr int kWorldTiles = kWorldPixels / kSide;

enum class Kind : std::uint8_t { Grid, Cloud };

/// One robot's maps of one kind; "" is the merged map.
struct Layer {
  std::string robot;
  Kind kind = Kind::Grid;
  friend auto operator<=>(const Layer&, const Layer&) = default;
};

inline Layer layer_of(const icd::MapUpdate& map) {
  return {map.name ? map.name->text() : "", map.is_grid() ? Kind::Grid : Kind::Cloud};
}

/// The tile that covers x to x + 1 and y to y + 1, in units of kSide pixels of its level.
struct TileAt {
  int level = 0, x = 0, y = 0;
  friend auto operator<=>(const TileAt&, const TileAt&) = default;
};

/// The tile of the next coarser level that this one lies in.
inline TileAt coarser(const TileAt& at) {
  static_assert(kStep == 4);
  return {at.level + 1, at.x >> 2, at.y >> 2};
}

/// A rectangle, in metres.
struct Area {
  double left = 0, bottom = 0, right = 0, top = 0;
  friend bool operator==(const Area&, const Area&) = default;
};

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

}  // namespace adit::picture
