#pragma once

#include <optional>
#include <vector>

#include "rehearsal/command_post/fields.hpp"

namespace adit::rehearsal {

struct Point {
  double x = 0, y = 0, z = 0;
};

struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};

struct Pose {
  Point position;
  Quaternion orientation;
};

/// A stamp and where it stands, so that the order of stamps can be checked (ICD 6.2).
struct Stamp {
  double seconds = 0;
  std::string path;
};

std::optional<Point> read_point(const Field& point);

/// `pose` holds "position" and "orientation". A quaternion that is not of length 1 is no rotation, though the
/// measured server takes it.
std::optional<Pose> read_pose(const Field& pose);

/// The optional "header" of `message` (ICD 6.1, 6.2): frame_id must be "darpa"; a stamp is added to `stamps`.
void read_header(const Field& message, std::vector<Stamp>& stamps);

}  // namespace adit::rehearsal
