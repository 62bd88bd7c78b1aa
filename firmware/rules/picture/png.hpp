#pragma once

#include <span>
#include <string>

#include "picture/palette.hpp"
#include "picture/tile.hpp"

namespace adit::picture {

/// A tile as an indexed PNG (ISO/IEC 15948) in which index 0 is transparent. The tile is deflated already, so
/// this takes some microseconds. `palette`: at least as many colours as the tile has indices, at most 256.
std::string write_png(const Packed& tile, std::span<const Colour> palette);

}  // namespace adit::picture
