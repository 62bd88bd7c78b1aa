#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "codec/row.hpp"
#include "facts/rows.hpp"
#include "icd/geometry.hpp"
#include "icd/mapping.hpp"

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
DrawnMarker draw_marker(const icd::Marker& marker);

/// Direction of the robot's x axis seen from above, in radians about z.
double heading_of(const icd::Quaternion& orientation);

using facts::Time;

/// A marker as last delivered.
struct MarkerRow {
  DrawnMarker marker;
  Time at = 0;  // time of delivery

  static const codec::Row kRow;
};

/// The scene of markers, or its changes.
struct MarkerChanges {
  std::uint64_t version = 0;
  bool whole = true;           // the whole scene; otherwise changes since the requested version
  std::uint64_t left_out = 0;  // markers beyond the limit
  std::vector<MarkerRow> markers;
  std::vector<std::pair<std::string, std::int32_t>> gone;  // ns and id

  static const codec::Row kRow;
};

/// A robot's pose at one time, in the frame "darpa".
struct TrackPose {
  Time at = 0;  // time of delivery
  icd::Point position;
  double heading = 0;  // radians about z; 0 is along x, left is positive
};

/// By 0.1 m or 0.2 radians.
bool has_moved(const TrackPose& from, const TrackPose& to);

struct Track {
  std::string robot;
  std::vector<TrackPose> poses;  // oldest first

  static const codec::Row kRow;
};

struct Tracks {
  std::vector<Track> tracks;

  static const codec::Row kRow;
};

}  // namespace adit::api
