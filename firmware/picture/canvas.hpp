#pragma once

#include <cstdint>
#include <map>

#include "picture/tile.hpp"

namespace adit::picture {

/// A layer as it is now, to be drawn upon. No tile in it ever changes, so that a worker may read it.
struct Canvas {
  std::uint64_t run = 0;         // which of the mosaic's runs it is of
  std::map<TileAt, Tile> tiles;  // none is null
};

}  // namespace adit::picture
