#pragma once

#include <cstdint>
#include <map>

#include "picture/tile.hpp"

namespace adit::picture {

/// The present tiles of a layer, to draw on. Tiles never change, so a worker may read them.
struct Canvas {
  std::uint64_t run = 0;         // the mosaic's run to which it belongs
  std::map<TileAt, Tile> tiles;  // never null
};

}  // namespace adit::picture
