#pragma once

#include <vector>

#include "api/scene.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

/// Ten minutes of a run, up to `now`: the merged grid of a cave that is explored bit by bit, and a robot's
/// clouds of its floor, which climbs from 0 to 6 m.
void draw_scene(picture::Mosaic& map, double now);

/// A marker of each type, along the tunnel, and an arrow by two points; one that cannot be seen, one that has
/// expired, and a line of more points than are drawn.
MarkerChanges scene_markers(double now);

/// Two robots on their ways, the last ten minutes up to `now`.
std::vector<Track> scene_tracks(double now);

}  // namespace adit::api
