#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "icd/geometry.hpp"
#include "icd/header.hpp"

namespace adit::icd {

enum class MarkerAction : std::uint8_t { Add = 0, Delete = 2, DeleteAll = 3 };

/// The largest type of ROS's visualization_msgs/Marker (TRIANGLE_LIST).
inline constexpr std::int32_t kLastMarkerType = 11;

/// Each component from 0 to 1.
struct Color {
  double r = 0, g = 0, b = 0, a = 0;
  friend bool operator==(const Color&, const Color&) = default;
};

/// One of POST /markers/update (ICD 6.6). For Delete and DeleteAll only ns and id mean anything.
struct Marker {
  Header header;
  std::string ns;
  std::int32_t id = 0;
  std::int32_t type = 0;  // 0 to kLastMarkerType
  MarkerAction action = MarkerAction::Add;
  Pose pose;
  Point scale;  // metres
  Color color;
  double lifetime = 0;  // seconds, not negative; 0: for ever
  std::string text;
  friend bool operator==(const Marker&, const Marker&) = default;
};

struct MarkersUpdate {
  std::vector<Marker> markers;
  friend bool operator==(const MarkersUpdate&, const MarkersUpdate&) = default;
};

}  // namespace adit::icd
