#pragma once

#include <optional>

namespace adit::icd {

/// Metres in the message's frame. Each component is finite.
struct Point {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// A rotation. Its length differs from 1 by at most kLengthNoise.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// The error of a length because of float32 and printed digits. A quaternion within it keeps its bits.
inline constexpr double kLengthNoise = 1e-6;

/// The rotation of `q`, which may have any length. All zeros are the identity, because ROS leaves an unset
/// quaternion so. nullopt if `q` is not finite, or shorter than kLengthNoise and thus without a direction.
std::optional<Quaternion> rotation_of(const Quaternion& q);

struct Pose {
  Point position;
  Quaternion orientation;
  friend bool operator==(const Pose&, const Pose&) = default;
};

}  // namespace adit::icd
