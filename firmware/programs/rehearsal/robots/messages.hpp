#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "rehearsal/agreed.hpp"

namespace adit::robots {

// The messages of a robot, before a client style gives them bytes. They are not those of the icd room, so
// that the simulated team cannot share a mistake with the gateway.

/// The rotation by `yaw` radians about z.
Rotation rotation_of(double yaw);

/// ICD 6.3.1: cells 0 to 100 or kUnknown, row by row from the lower left.
struct Grid {
  double stamp = 0;
  double resolution = 0;
  std::uint32_t width = 0, height = 0;
  Placement origin = {};
  std::vector<std::uint8_t> cells = {};
};

struct Cloud {
  double stamp = 0;
  std::optional<Placement> origin = {};
  std::vector<CloudField> fields = {};
  std::uint32_t point_step = 0;
  std::vector<std::uint8_t> data = {};  // little endian
};

/// One robot's pose: ICD 6.5 with a single entry, as teams send it.
struct RobotState {
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
  std::string ns = {};
  int id = 0;
  Type type = Sphere;
  Action action = Add;
  Vector3 position = {};
  double size = 0.3;  // metres
  Color color = {};
  double lifetime = 0;  // seconds
  std::string text = {};
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

using Message = std::variant<Grid, Cloud, RobotState, Markers, Report, StatusQuery>;

/// What the summary counts: the messages, and the questions a browser asks before each of them.
enum class MessageKind : std::uint8_t { Grid, Cloud, State, Markers, Report, Status, Preflight };
inline constexpr std::size_t kKinds = static_cast<std::size_t>(MessageKind::Preflight) + 1;

MessageKind kind_of(const Message& message);
std::string_view name_of(MessageKind kind);

/// How a map's `data` is written.
enum class DataForm : std::uint8_t {
  Bytes,     // a CBOR byte string
  Base64,    // a JSON string
  Integers,  // a JSON array, -1 for unknown (grids alone; clouds are Base64 beside it)
};

/// One way in which teams' software speaks to a Command Post. All of them are in use in the field.
struct Style {
  std::string_view name;
  bool cbor = false;
  DataForm data = DataForm::Base64;
  bool gzip_data = false;  // "compression": "gzip"
  bool gzip_body = false;  // Content-Encoding: gzip
  bool ros = false;        // whole ROS dictionaries: seq, ROS's times, integers where floats are asked for,
                           // quaternions of all zeros and of length 2, rows with padding, maps without a name
  bool browser = false;    // a CORS preflight first, a charset, a trailing slash, `bearer`
};

inline constexpr std::array kStyles = {
    Style{.name = "cbor", .cbor = true, .data = DataForm::Bytes, .gzip_data = true},
    Style{.name = "cbor-body-gzip", .cbor = true, .data = DataForm::Bytes, .gzip_body = true},
    Style{.name = "json-base64", .gzip_data = true},
    Style{.name = "json-array", .data = DataForm::Integers},
    Style{.name = "ros", .data = DataForm::Integers, .ros = true},
    Style{.name = "browser", .browser = true},
    Style{.name = "cbor-plain", .cbor = true, .data = DataForm::Bytes},
};

/// What a team speaks: one style, or all in turn (`mixed`).
struct TeamStyle {
  std::span<const Style> styles = kStyles;

  static std::expected<TeamStyle, std::string> parse(std::string_view name);

  const Style& style_of(std::size_t robot) const { return styles[robot % styles.size()]; }
};

/// One gzip member (RFC 1952).
std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes);

/// RFC 4648 section 4, padded.
std::string base64(std::span<const std::uint8_t> bytes);

struct HttpRequest {
  std::string method;
  std::string target;
  std::vector<std::pair<std::string, std::string>> fields;  // beside Host and Content-Length
  std::string body;
};

/// Gives one robot's messages the bytes that clients of its style send. Independent of Adit's codec.
class Encoder {
 public:
  /// `style` outlives the encoder.
  Encoder(std::string robot, const Style& style, std::string token);

  HttpRequest encode(const Message& message);

  /// What a browser asks before it sends `request` (the Fetch standard's CORS preflight): no token, no body.
  static HttpRequest preflight(const HttpRequest& request);
  static constexpr const char* kOrigin = "http://operator-station.local";

 private:
  std::string robot_;
  const Style& style_;
  std::string token_;
  std::uint32_t seq_ = 0;  // of ROS headers
};

}  // namespace adit::robots
