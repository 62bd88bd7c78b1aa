#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "api/drawn_marker.hpp"
#include "codec/row.hpp"
#include "icd/geometry.hpp"

namespace adit::api {

/// Seconds since 1970 on the gateway's clock.
using Time = double;

/// A marker as the Command Post was last told of it.
struct MarkerRow {
  DrawnMarker marker;
  Time at = 0;  // when that was forwarded

  static const codec::Row kRow;
};

/// The markers' scene, or what changed of it.
struct MarkerChanges {
  std::uint64_t version = 0;
  bool whole = true;           // all that there is; else what changed since the version that was asked for
  std::uint64_t left_out = 0;  // there were more than are kept
  std::vector<MarkerRow> markers;
  std::vector<std::pair<std::string, std::int32_t>> gone;  // ns and id

  static const codec::Row kRow;
};

/// Where a robot was, in the frame "darpa".
struct TrackPose {
  Time at = 0;  // when it was forwarded
  icd::Point position;
  double heading = 0;  // radians about z: 0 along x, left is more
};

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
