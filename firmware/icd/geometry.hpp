#pragma once

#include <optional>

namespace adit::icd {

/// Metres, in the frame that the message names; each component is finite.
struct Point {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// A rotation: its length differs from 1 by kLengthNoise at most.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// What float32 and printed digits make of a length. The bits of a quaternion whose length differs from 1 by
/// no more are kept.
inline constexpr double kLengthNoise = 1e-6;

/// The rotation of `q`, which may have any length: all zeros are the identity, for so ROS leaves one that
/// nobody set. Nothing if `q` is not finite, or shorter than kLengthNoise and so without a direction.
std::optional<Quaternion> rotation_of(const Quaternion& q);

struct Pose {
  Point position;
  Quaternion orientation;
  friend bool operator==(const Pose&, const Pose&) = default;
};

}  // namespace adit::icd
