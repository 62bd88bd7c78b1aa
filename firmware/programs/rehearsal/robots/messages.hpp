#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace adit::robots {

/// What a robot has to say, before a client style gives it bytes. Deliberately not Adit's own icd room: the
/// simulated team must not share a mistake with the gateway that it rehearses against.

/// Metres, in the "darpa" frame.
struct Vector3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vector3&, const Vector3&) = default;
};

struct Rotation {
  double x = 0, y = 0, z = 0, w = 1;
  friend bool operator==(const Rotation&, const Rotation&) = default;
};

/// The rotation by `yaw` radians about z.
Rotation rotation_of(double yaw);

struct Placement {
  Vector3 position;
  Rotation orientation;
  friend bool operator==(const Placement&, const Placement&) = default;
};

inline constexpr std::uint8_t kUnknown = 255;

/// ICD 6.3.1: cells 0 to 100 or kUnknown, row by row from the lower left.
struct Grid {
  double stamp = 0;
  double resolution = 0;
  std::uint32_t width = 0, height = 0;
  Placement origin;
  std::vector<std::uint8_t> cells;
};

/// ICD 6.3.2. `datatype` is the ICD's number: 1 to 8.
struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  int datatype = 0;
  std::uint32_t count = 1;
  friend bool operator==(const CloudField&, const CloudField&) = default;
};

inline constexpr int kFloat32 = 7;
inline constexpr int kFloat64 = 8;

/// Bytes of one value of the ICD's datatype 1 to 8.
std::uint32_t bytes_of(int datatype);

struct Cloud {
  double stamp = 0;
  std::optional<Placement> origin;
  std::vector<CloudField> fields;
  std::uint32_t point_step = 0;
  std::vector<std::uint8_t> data;  // little endian
};

/// One robot's pose: ICD 6.5 with a single entry, as teams send it.
struct State {
  double stamp = 0;
  std::string robot;
  Placement pose;
};

struct Color {
  double r = 0, g = 0, b = 0, a = 1;
};

/// ICD 6.6; types and actions are ROS's numbers.
struct Marker {
  enum Type : int { Cube = 1, Sphere = 2, LineStrip = 4, Text = 9, Mesh = 10 };
  enum Action : int { Add = 0, Delete = 2 };
  std::string ns;
  int id = 0;
  Type type = Sphere;
  Action action = Add;
  Vector3 position;
  double size = 0.3;  // metres
  Color color;
  double lifetime = 0;  // seconds
  std::string text;
  std::vector<Vector3> points = {};  // of a LineStrip
  std::string mesh_resource = {};    // of a Mesh
};

struct Markers {
  double stamp = 0;
  std::vector<Marker> markers;
};

/// ICD 5.2.
struct Report {
  std::string type;
  Vector3 position;
};

/// ICD 5.1, which has no body.
struct StatusQuery {};

using Message = std::variant<Grid, Cloud, State, Markers, Report, StatusQuery>;

/// What the summary counts: the messages, and the questions a browser asks before each of them.
enum class Kind : std::uint8_t { Grid, Cloud, State, Markers, Report, Status, Preflight };
inline constexpr std::size_t kKinds = 7;

Kind kind_of(const Message& message);
std::string_view name_of(Kind kind);

}  // namespace adit::robots
