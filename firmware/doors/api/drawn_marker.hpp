#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "icd/geometry.hpp"
#include "icd/markers_update.hpp"

namespace adit::api {

/// A point seen from above, in metres of the frame "darpa".
struct FlatPoint {
  float x = 0, y = 0;
  friend bool operator==(const FlatPoint&, const FlatPoint&) = default;
};

/// A marker for a map from above, with bounded size. Its parts are the points of a strip or list, the lines
/// of a LineList (two points each), or the triangles of a TriangleList (three points each).
struct DrawnMarker {
  static constexpr std::size_t kMostPoints = 1000;
  static constexpr std::size_t kLongestText = 120;  // bytes

  std::string ns = {};
  std::int32_t id = 0;
  std::int32_t type = 0;  // icd::MarkerType
  icd::Point position = {};
  double heading = 0;     // radians about z
  icd::Point scale = {};  // metres
  icd::Color color = {};
  double lifetime = 0;                  // seconds; 0: unlimited
  std::string text = {}, mesh = {};     // `mesh`: file name without directory and ending
  std::vector<FlatPoint> points = {};   // with the pose applied; thinned beyond kMostPoints
  std::vector<icd::Color> colors = {};  // empty, or one for each part
  std::size_t point_count = 0;          // before thinning

  /// Approximate size as JSON.
  std::size_t size() const;
};

/// Thins a long strip evenly along its length, and a long list evenly by parts.
DrawnMarker drawn(const icd::Marker& marker);

/// Direction of the robot's x axis seen from above, in radians about z.
double heading_of(const icd::Quaternion& orientation);

}  // namespace adit::api
