#pragma once

#include "picture/mosaic.hpp"

namespace adit::page {

/// Ten minutes of a run, up to `now`: the merged grid of a cave that is explored bit by bit, and a robot's
/// clouds of its floor, which climbs from 0 to 6 m.
void draw_scene(picture::Mosaic& map, double now);

}  // namespace adit::page
