#pragma once

namespace adit::icd {

/// Metres, in the frame that the message names; each component is finite.
struct Point {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// A rotation; never all zeros (a sender's all-zero quaternion has become the identity).
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

struct Pose {
  Point position;
  Quaternion orientation;
  friend bool operator==(const Pose&, const Pose&) = default;
};

}  // namespace adit::icd
