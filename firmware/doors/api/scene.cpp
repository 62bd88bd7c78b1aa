#include "api/scene.hpp"

#include <algorithm>
#include <cmath>

#include "icd/hex.hpp"

namespace adit::api {
namespace {

using codec::Field;
using codec::Kind;
using codec::Member;
using codec::member;
using codec::Row;
using codec::Value;

/// Rounds to a hundredth, finer than any screen.
Value rounded(double value) {
  return {std::round(value * 100) / 100};
}

constexpr Kind kRounded = {
    .write = [](const void* value) { return rounded(*static_cast<const double*>(value)); },
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
Value as_hex(const icd::Color& color) {
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
    for (const icd::Color& color : colors) array.push_back(api::as_hex(color));
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
      array.push_back(api::rounded(x));
      array.push_back(api::rounded(y));
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
    return {Value::Array{api::rounded(pose.at), api::rounded(pose.position.x), api::rounded(pose.position.y),
                         api::rounded(pose.position.z), api::rounded(pose.heading)}};
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
constexpr Row MarkerChanges::kRow = {"Markers", kChanges};
constexpr Row Track::kRow = {"", kTrack};
constexpr Row Tracks::kRow = {"Tracks", kTracks};

bool has_moved(const TrackPose& from, const TrackPose& to) {
  constexpr double kMoved = 0.1, kTurned = 0.2;
  const double x = to.position.x - from.position.x, y = to.position.y - from.position.y,
               z = to.position.z - from.position.z;
  const double turned = std::abs(std::remainder(to.heading - from.heading, 2 * M_PI));
  return std::hypot(x, y, z) >= kMoved || turned >= kTurned;
}

}  // namespace adit::api
