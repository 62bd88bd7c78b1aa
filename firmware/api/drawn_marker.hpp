#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "icd/geometry.hpp"
#include "icd/markers_update.hpp"

namespace adit::api {

/// A place seen from above, in metres of the frame "darpa".
struct FlatPoint {
  float x = 0, y = 0;
  friend bool operator==(const FlatPoint&, const FlatPoint&) = default;
};

/// What a map from above shows of a marker; its size is bounded. Its parts are the points of a strip or of a
/// list, the lines of a LineList (two points each), the triangles of a TriangleList (three points each).
struct DrawnMarker {
  static constexpr std::size_t kMostPoints = 1000;
  static constexpr std::size_t kLongestText = 120;  // bytes

  std::string ns = {};
  std::int32_t id = 0;
  std::int32_t type = 0;  // an icd::MarkerType
  icd::Point position = {};
  double heading = 0;     // radians about z
  icd::Point scale = {};  // metres
  icd::Color color = {};
  double lifetime = 0;                 // seconds; 0: for ever
  std::string text = {}, mesh = {};    // `mesh`: the file's name, without folder and ending
  std::vector<FlatPoint> points = {};  // with the pose applied; thinned where there are more than kMostPoints
  std::vector<icd::Color> colors = {};  // none, or one for each part
  std::size_t point_count = 0;          // before they were thinned

  /// About what it takes as JSON.
  std::size_t size() const;
};

/// Too long a strip loses points evenly along its way; too long a list loses parts evenly.
DrawnMarker drawn(const icd::Marker& marker);

/// Where the robot's own x axis points, seen from above: radians about z.
double heading_of(const icd::Quaternion& orientation);

}  // namespace adit::api
