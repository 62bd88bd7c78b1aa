#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "icd/geometry.hpp"
#include "icd/header.hpp"
#include "icd/robot_name.hpp"

namespace adit::icd {

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

/// How MapData's bytes are compressed.
enum class Compression : std::uint8_t {
  None,
  Gzip,  // exactly one member (RFC 1952) and no bytes after it
};

/// A map's `data`. `raw_size` is its uncompressed size in bytes: width * height for a grid, a multiple of
/// point_step for a cloud.
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

}  // namespace adit::icd
