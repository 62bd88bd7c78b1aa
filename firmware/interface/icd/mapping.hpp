#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "icd/geometry.hpp"
#include "icd/robot_name.hpp"

namespace adit::icd {

/// Seconds on the sender's clock, from 0 (ICD 6.2) to kLatestStamp.
using Stamp = double;
inline constexpr Stamp kLatestStamp = 0x1.fffffffffffffp31;  // ROS has its seconds in a uint32

/// The frame of every message (ICD 6.1), checked when the message is parsed, so a Header does not contain it.
inline constexpr const char* kFrame = "darpa";

struct Header {
  std::optional<Stamp> stamp;
  friend bool operator==(const Header&, const Header&) = default;
};

struct NamedPose {
  RobotName name;
  Pose pose;
  friend bool operator==(const NamedPose&, const NamedPose&) = default;
};

/// The body of POST /state/update (ICD 6.5). Each name is in `poses` at most once.
struct StateUpdate {
  Header header;
  std::vector<NamedPose> poses;
  friend bool operator==(const StateUpdate&, const StateUpdate&) = default;
};

/// The values of an OccupancyGrid's cells (ICD 6.3.1): 0 to 100 per cent, or unknown.
inline constexpr std::uint8_t kMostOccupied = 100;
inline constexpr std::uint8_t kUnknownCell = 255;

/// OccupancyGrid without its cells (ICD 6.3.1). Cells are row by row towards +Y, from the lower left.
struct OccupancyGrid {
  Header header;
  double resolution = 0;     // metres a cell; finite and above 0 as a float32
  std::uint32_t width = 0;   // cells towards +X; at least 1
  std::uint32_t height = 0;  // cells towards +Y; at least 1
  Pose origin;               // of the lower left corner, in "darpa"
  friend bool operator==(const OccupancyGrid&, const OccupancyGrid&) = default;
};

/// PointField datatypes (ICD 6.3.2).
enum class Datatype : std::uint8_t { Int8 = 1, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

/// Bytes of one value of that type: 1, 2, 4 or 8.
std::size_t size_of(Datatype datatype);

struct FieldSchema {
  std::string name;
  std::uint32_t offset = 0;  // bytes from the start of a point
  Datatype datatype = Datatype::Float32;
  std::uint32_t count = 1;  // at least 1
  friend bool operator==(const FieldSchema&, const FieldSchema&) = default;
};

/// PointCloud2 without its points (ICD 6.3.2). `fields` has x, y and z once each, all Float32 or all Float64,
/// each with count 1. Every field ends within point_step.
struct PointCloud2 {
  Header header;
  std::optional<Pose> origin;  // from the points' frame to "darpa"; absent: identity
  std::vector<FieldSchema> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;  // bytes; at least 1
  friend bool operator==(const PointCloud2&, const PointCloud2&) = default;
};

/// The field of that name. Requires it.
const FieldSchema& field_of(const PointCloud2& cloud, std::string_view name);
/// The offsets of x, y and z in a point.
std::array<std::size_t, 3> axes_of(const PointCloud2& cloud);

enum class Compression : std::uint8_t {
  None,
  Gzip,  // exactly one member (RFC 1952) and no bytes after it
};

/// A map's `data`. `raw_size`: bytes when uncompressed: width * height, or a multiple of point_step.
struct MapData {
  ChunkedBytes bytes;
  Compression compression = Compression::None;
  std::size_t raw_size = 0;
  friend bool operator==(const MapData&, const MapData&) = default;
};

/// The body of POST /map/update (ICD 6.4).
struct MapUpdate {
  std::optional<RobotName> name;  // absent: merged from all robots
  std::variant<OccupancyGrid, PointCloud2> msg;
  MapData data;

  bool is_grid() const { return std::holds_alternative<OccupancyGrid>(msg); }
  const Header& header() const;
  Header& header();
  friend bool operator==(const MapUpdate&, const MapUpdate&) = default;
};

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

/// True if the marker is added and invisible: alpha 0 (ROS's default), and no colors of its points or mesh.
bool is_invisible(const Marker& marker);

/// The bytes that a marker takes in memory or in a message: at least the larger, and little more.
std::size_t bytes_of(const Marker& marker);

struct MarkersUpdate {
  std::vector<Marker> markers;
  friend bool operator==(const MarkersUpdate&, const MarkersUpdate&) = default;
};

}  // namespace adit::icd
