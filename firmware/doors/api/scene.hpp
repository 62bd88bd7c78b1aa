#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "api/drawn_marker.hpp"
#include "codec/row.hpp"
#include "icd/geometry.hpp"

namespace adit::api {

/// Seconds since 1970 by the gateway's clock.
using Time = double;

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
