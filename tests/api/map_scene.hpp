#pragma once

#include <vector>

#include "api/scene.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

/// Draws ten minutes of a run up to `now`: the merged grid of a cave that is explored step by step, and a
/// robot's clouds of its floor, which climbs from 0 to 6 m.
void draw_scene(picture::Mosaic& map, double now);

/// A marker of each type along the tunnel, and an arrow by two points. Also an invisible marker, an expired
/// one, and a line with more points than are drawn.
MarkerChanges scene_markers(double now);

/// Tracks of two robots over the last ten minutes up to `now`.
std::vector<Track> scene_tracks(double now);

/// A marker with a value in each member, as the box stores it for drawing.
inline DrawnMarker drawn_marker() {
  return {.ns = "path",
          .id = -3,
          .type = 4,
          .position = {1, 2, 3},
          .heading = 1.5708,
          .scale = {4, 5, 6},
          .color = {0.5, 0.25, 1, 0.126},
          .lifetime = 2.5,
          .text = "here",
          .mesh = "drill",
          .points = {{1, 2}, {-3.456F, 4}},
          .colors = {{1, 0, 0.5, 1}},
          .point_count = 7000};
}

}  // namespace adit::api
