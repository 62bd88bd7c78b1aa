#include "api/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "icd/geometry.hpp"
#include "icd/text.hpp"

namespace adit::api {
namespace {

using icd::Marker;
using icd::MarkerType;
using icd::Point;

std::string beginning(std::string_view text) {
  return std::string(icd::beginning_of(text, DrawnMarker::kLongestText));
}

/// "drill" of "package://artifacts/meshes/drill.dae".
std::string file_name(const std::string& url) {
  std::string name = url.substr(url.rfind('/') + 1);
  if (const auto dot = name.rfind('.'); dot != std::string::npos && dot > 0) name.resize(dot);
  return beginning(name);
}

/// Points of one part; 0: the marker has no points.
std::size_t corners_of(const Marker& marker) {
  switch (static_cast<MarkerType>(marker.type)) {
    case MarkerType::LineStrip:
    case MarkerType::CubeList:
    case MarkerType::SphereList:
    case MarkerType::Points:
      return 1;
    case MarkerType::LineList:
      return 2;
    case MarkerType::TriangleList:
      return 3;
    case MarkerType::Arrow:
      return marker.points.size() >= 2 ? 2 : 0;
    default:
      return 0;
  }
}

double point_distance(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

double length_of(const std::vector<Point>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += point_distance(points[i - 1], points[i]);
  return length;
}

/// Points of a strip at even distances along it, with both ends, so that time at rest has no weight.
std::vector<std::size_t> evenly_spaced(const std::vector<Point>& points, double length) {
  const double step = length / static_cast<double>(DrawnMarker::kMostPoints - 2);
  std::vector<std::size_t> kept = {0};
  double gone = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    gone += point_distance(points[i - 1], points[i]);
    if (gone < step || gone == 0) continue;
    kept.push_back(i);
    gone = 0;
  }
  kept.push_back(points.size() - 1);
  return kept;
}

std::vector<std::size_t> kept_parts(const Marker& marker, std::size_t parts, std::size_t corners) {
  const std::size_t most = DrawnMarker::kMostPoints / corners;
  if (parts > most && marker.is(MarkerType::LineStrip)) {
    // A strip of infinite length has no even distances and is thinned like a list.
    if (const double length = length_of(marker.points); std::isfinite(length))
      return evenly_spaced(marker.points, length);
  }
  const std::size_t each = std::max<std::size_t>(1, (parts + most - 1) / most);
  std::vector<std::size_t> kept;
  for (std::size_t part = 0; part < parts; part += each) kept.push_back(part);
  return kept;
}

/// Undefined values (a sum of opposite infinities) become 0, values outside float's range its largest.
float to_float(double value) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return std::isnan(value) ? 0 : static_cast<float>(std::clamp(value, -kMost, kMost));
}

/// The pose's rotation and shift, seen from above.
class Placing {
 public:
  explicit Placing(const Marker& marker) : placement_(marker.pose) {
    // Scale applies to the corners of a TriangleList, and to the symbols at the points of other markers.
    const auto scale = [&](double along) {
      return marker.is(MarkerType::TriangleList) && along != 0 ? along : 1;
    };
    scale_ = {scale(marker.scale.x), scale(marker.scale.y), scale(marker.scale.z)};
  }

  FlatPoint operator()(const Point& point) const {
    const Point placed = placement_({point.x * scale_.x, point.y * scale_.y, point.z * scale_.z});
    return {to_float(placed.x), to_float(placed.y)};
  }

 private:
  icd::Placement placement_;
  Point scale_;
};

/// The colour of a part: of its first point, or of a triangle. Null if the number of colours fits neither.
const icd::Color* color_of(const Marker& marker, std::size_t part, std::size_t corners) {
  const std::size_t colors = marker.colors.size(), points = marker.points.size();
  if (colors == points) return &marker.colors[part * corners];
  return corners == 3 && colors == points / 3 ? &marker.colors[part] : nullptr;
}

void draw_points(const Marker& marker, DrawnMarker& shown) {
  const std::size_t corners = corners_of(marker);
  if (corners == 0) return;
  const std::size_t parts = marker.is(MarkerType::Arrow) ? 1 : marker.points.size() / corners;
  shown.point_count = parts * corners;
  if (parts == 0) return;
  const Placing place(marker);
  for (const std::size_t part : kept_parts(marker, parts, corners)) {
    for (std::size_t corner = 0; corner < corners; ++corner) {
      shown.points.push_back(place(marker.points[part * corners + corner]));
    }
    if (const icd::Color* color = color_of(marker, part, corners)) shown.colors.push_back(*color);
  }
}

}  // namespace

double heading_of(const icd::Quaternion& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
}

std::size_t DrawnMarker::size() const {
  constexpr std::size_t kFixed = 320, kPoint = 16, kColor = 12;
  return kFixed + ns.size() + text.size() + mesh.size() + kPoint * points.size() + kColor * colors.size();
}

DrawnMarker draw_marker(const icd::Marker& marker) {
  DrawnMarker shown{.ns = marker.ns,
                    .id = marker.id,
                    .type = marker.type,
                    .position = marker.pose.position,
                    .heading = heading_of(marker.pose.orientation),
                    .scale = marker.scale,
                    .color = marker.color,
                    .lifetime = marker.lifetime,
                    .text = beginning(marker.text),
                    .mesh = file_name(marker.mesh_resource)};
  draw_points(marker, shown);
  return shown;
}

namespace {

using codec::Member;
using codec::member;
using codec::Row;
using codec::RowKind;
using codec::Value;

/// Rounds to a hundredth, finer than any screen.
Value rounded_value(double value) {
  return {std::round(value * 100) / 100};
}

constexpr RowKind kRounded = {
    .write = [](const void* value) { return rounded_value(*static_cast<const double*>(value)); },
    .read = codec::kind_of<double>.read,
    .schema = codec::kind_of<double>.schema};

constexpr Member kColorMembers[] = {
    member<&icd::Color::r>("r").as(kRounded), member<&icd::Color::g>("g").as(kRounded),
    member<&icd::Color::b>("b").as(kRounded), member<&icd::Color::a>("a").as(kRounded)};
constexpr Row kColor = {"", kColorMembers};

using Gone = std::pair<std::string, std::int32_t>;
constexpr Member kGoneMembers[] = {member<&Gone::first>("ns"), member<&Gone::second>("id")};
constexpr Row kGone = {"", kGoneMembers};

/// "#rrggbbaa", because a list may have a thousand colours.
Value to_hex(const icd::Color& color) {
  std::string text = "#";
  for (const double part : {color.r, color.g, color.b, color.a}) {
    text += icd::hex(static_cast<std::uint8_t>(std::lround(255 * std::clamp(part, 0.0, 1.0))));
  }
  return {std::move(text)};
}

}  // namespace
}  // namespace adit::api

namespace adit::codec {

template <>
struct KindOf<icd::Color> : KindOfRow<icd::Color, api::kColor> {};
template <>
struct KindOf<api::Gone> : KindOfRow<api::Gone, api::kGone> {};

template <>
struct KindOf<std::vector<icd::Color>> : WriteOnly {
  static Value write(const std::vector<icd::Color>& colors) {
    Value::Array array;
    array.reserve(colors.size());
    for (const icd::Color& color : colors) array.push_back(api::to_hex(color));
    return {std::move(array)};
  }
  static constexpr Schema kOne = {.type = "string", .more = R"("pattern":"^#[0-9a-f]{8}$")"};
  static constexpr Schema schema = {.type = "array", .items = &kOne};
};

/// x, y, x, y, ...
template <>
struct KindOf<std::vector<api::FlatPoint>> : WriteOnly {
  static Value write(const std::vector<api::FlatPoint>& points) {
    Value::Array array;
    array.reserve(2 * points.size());
    for (const auto& [x, y] : points) {
      array.push_back(api::rounded_value(x));
      array.push_back(api::rounded_value(y));
    }
    return {std::move(array)};
  }
  static constexpr Schema schema = {
      .type = "array", .items = &KindOf<double>::schema, .most = 2 * api::DrawnMarker::kMostPoints};
};

/// Five numbers, because a track has thousands of poses.
template <>
struct KindOf<api::TrackPose> : WriteOnly {
  static Value write(const api::TrackPose& pose) {
    return {Value::Array{api::rounded_value(pose.at), api::rounded_value(pose.position.x),
                         api::rounded_value(pose.position.y), api::rounded_value(pose.position.z),
                         api::rounded_value(pose.heading)}};
  }
  static constexpr Schema schema = {
      .type = "array", .items = &KindOf<double>::schema, .fewest = 5, .most = 5};
};

}  // namespace adit::codec

namespace adit::api {
namespace {

constexpr Member kMarker[] = {
    member<&MarkerRow::marker, &DrawnMarker::ns>("ns"),
    member<&MarkerRow::marker, &DrawnMarker::id>("id"),
    member<&MarkerRow::marker, &DrawnMarker::type>("type").from(0).to(11),
    member<&MarkerRow::marker, &DrawnMarker::position>("position"),
    member<&MarkerRow::marker, &DrawnMarker::heading>("heading", "radians about z").as(kRounded),
    member<&MarkerRow::marker, &DrawnMarker::scale>("scale"),
    member<&MarkerRow::marker, &DrawnMarker::color>("color"),
    member<&MarkerRow::marker, &DrawnMarker::points>(
        "points",
        "x, y, x, y, ... in metres of the frame darpa, seen from above: with the pose applied, thinned"),
    member<&MarkerRow::marker, &DrawnMarker::colors>(
        "colors",
        "empty, or one colour for each point of points (LINE_LIST: each line; TRIANGLE_LIST: each triangle)"),
    member<&MarkerRow::marker, &DrawnMarker::point_count>("point_count", "number of points"),
    member<&MarkerRow::marker, &DrawnMarker::text>("text", "its first 120 bytes"),
    member<&MarkerRow::marker, &DrawnMarker::mesh>(
        "mesh", "file name of mesh_resource, without directory and extension"),
    member<&MarkerRow::marker, &DrawnMarker::lifetime>("lifetime").from(0),
    member<&MarkerRow::at>("at", "when the marker was forwarded"),
};

constexpr Member kChanges[] = {
    member<&MarkerChanges::version>("version"),
    member<&MarkerChanges::whole>("whole", "whether markers has all markers"),
    member<&MarkerChanges::left_out>("left_out", "number of older markers that were left out"),
    member<&MarkerChanges::markers>("markers"),
    member<&MarkerChanges::gone>("gone"),
};

constexpr Member kTrack[] = {
    member<&Track::robot>("robot"),
    member<&Track::poses>("poses", "at, x, y, z, heading"),
};

constexpr Member kTracks[] = {member<&Tracks::tracks>("tracks")};

}  // namespace

constexpr Row MarkerRow::kRow = {"Marker", kMarker};
constexpr Row MarkerChanges::kRow = codec::complete<MarkerChanges>({"Markers", kChanges});
constexpr Row Track::kRow = codec::complete<Track>({"", kTrack});
constexpr Row Tracks::kRow = codec::complete<Tracks>({"Tracks", kTracks});

bool has_moved(const TrackPose& from, const TrackPose& to) {
  constexpr double kMoved = 0.1, kTurned = 0.2;
  const double turned = std::abs(std::remainder(to.heading - from.heading, 2 * M_PI));
  return point_distance(from.position, to.position) >= kMoved || turned >= kTurned;
}

}  // namespace adit::api
