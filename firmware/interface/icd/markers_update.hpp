#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "icd/geometry.hpp"
#include "icd/header.hpp"

namespace adit::icd {

enum class MarkerAction : std::uint8_t { Add = 0, Delete = 2, DeleteAll = 3 };

/// The types of ROS's visualization_msgs/Marker. LineStrip to Points and TriangleList are made of `points`.
/// An Arrow may be given by two points, its tail and its tip.
enum class MarkerType : std::int32_t {
  Arrow,
  Cube,
  Sphere,
  Cylinder,
  LineStrip,
  LineList,
  CubeList,
  SphereList,
  Points,
  TextViewFacing,
  MeshResource,
  TriangleList,
};
inline constexpr auto kLastMarkerType = static_cast<std::int32_t>(MarkerType::TriangleList);

inline constexpr std::size_t kMostMarkers = 100'000;  // in one update
inline constexpr std::size_t kMostMarkerPoints = 100'000;
inline constexpr std::size_t kLongestMeshResource = 4096;         // bytes
inline constexpr double kLongestLifetime = 0x1.fffffffffffffp30;  // ROS has its seconds in an int32

/// Each component from 0 to 1.
struct Color {
  double r = 0, g = 0, b = 0, a = 0;
  friend bool operator==(const Color&, const Color&) = default;
};

/// The namespace for markers without one. The organiser's display deletes markers with an empty namespace if
/// a message has fewer markers than the previous one, and Adit merges messages.
inline constexpr const char* kUnnamedMarkers = "unnamed";

/// A marker of POST /markers/update (ICD 6.6): a whole visualization_msgs/Marker of ROS 1. The ICD encodes it
/// (2.2) and lists some members. Only ns and id matter for Delete and DeleteAll.
struct Marker {
  Header header;
  std::string ns;
  std::int32_t id = 0;
  std::int32_t type = 0;  // a MarkerType
  MarkerAction action = MarkerAction::Add;
  Pose pose;
  Point scale;  // metres
  Color color;
  double lifetime = 0;  // seconds, from 0 to kLongestLifetime; 0: for ever
  Stamp expires = 0;    // by the gateway's clock, if it was accepted with a lifetime; in no message
  std::string text;
  bool frame_locked = false;       // moves with its frame
  std::vector<Point> points = {};  // metres from `pose`; at most kMostMarkerPoints
  std::vector<Color> colors = {};  // as received; used if there is one for each point, or each triangle
  std::string mesh_resource = {};  // the URL of a MeshResource; at most kLongestMeshResource
  bool mesh_use_embedded_materials = false;

  bool is(MarkerType other) const { return type == static_cast<std::int32_t>(other); }
  friend bool operator==(const Marker&, const Marker&) = default;
};

/// True if the marker is added and cannot be seen: its color has alpha 0 (ROS's default, ICD 6.6), and
/// neither its points nor its mesh have colors of their own.
bool is_invisible(const Marker& marker);

/// The bytes that a marker takes in memory or in a message: at least the larger, and little more.
std::size_t bytes_of(const Marker& marker);

struct MarkersUpdate {
  std::vector<Marker> markers;
  friend bool operator==(const MarkersUpdate&, const MarkersUpdate&) = default;
};

}  // namespace adit::icd
