#pragma once

#include "picture/draw.hpp"
#include "picture/sheet.hpp"

namespace adit::picture {

/// Lays a map's sheet over `before`, at all levels. Fills in the drawing's tiles, area and heights. Its layer
/// must be set.
void lay(const Sheet& sheet, const Canvas& before, Drawing& drawing);

}  // namespace adit::picture
