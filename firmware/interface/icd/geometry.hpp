#pragma once

#include <array>
#include <cmath>
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
  bool is_turned() const { return x != 0 || y != 0 || z != 0; }
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

/// Leads from a map's own frame to "darpa": a rotation by a matrix, then a shift.
struct Placement {
  explicit Placement(const Pose& pose) : shift{pose.position} {
    auto [x, y, z, w] = pose.orientation;
    const double norm = std::sqrt(x * x + y * y + z * z + w * w);
    x /= norm, y /= norm, z /= norm, w /= norm;
    turn = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
             {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  }

  Point operator()(const Point& p) const {
    return {turn[0][0] * p.x + turn[0][1] * p.y + turn[0][2] * p.z + shift.x,
            turn[1][0] * p.x + turn[1][1] * p.y + turn[1][2] * p.z + shift.y,
            turn[2][0] * p.x + turn[2][1] * p.y + turn[2][2] * p.z + shift.z};
  }

  std::array<std::array<double, 3>, 3> turn;  // rows
  Point shift;
};

}  // namespace adit::icd
