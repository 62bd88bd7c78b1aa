#include <algorithm>
#include <cmath>

#include "api/as_json.hpp"
#include "api/scene.hpp"
#include "codec/json.hpp"

namespace adit::api {
namespace {

using codec::Value;

/// A hundredth is finer than any screen shows.
Value rounded(double value) {
  return json(std::round(value * 100) / 100);
}

Value json(const icd::Color& color) {
  return {Value::Object{
      {"r", rounded(color.r)}, {"g", rounded(color.g)}, {"b", rounded(color.b)}, {"a", rounded(color.a)}}};
}

/// "#rrggbbaa": a list may have a thousand of them.
Value as_hex(const icd::Color& color) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const double part : {color.r, color.g, color.b, color.a}) {
    const auto byte = static_cast<std::size_t>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
    text += {kDigits[byte / 16], kDigits[byte % 16]};
  }
  return {std::move(text)};
}

Value hex_of(const std::vector<icd::Color>& colors) {
  Value::Array array;
  array.reserve(colors.size());
  for (const icd::Color& color : colors) array.push_back(as_hex(color));
  return {std::move(array)};
}

/// x, y, x, y, ...
Value flat(const std::vector<FlatPoint>& points) {
  Value::Array array;
  array.reserve(2 * points.size());
  for (const auto& [x, y] : points) {
    array.push_back(rounded(x));
    array.push_back(rounded(y));
  }
  return {std::move(array)};
}

Value json(const MarkerRow& row) {
  const DrawnMarker& marker = row.marker;
  return {Value::Object{{"ns", api::json(marker.ns)},
                        {"id", api::json(marker.id)},
                        {"type", api::json(marker.type)},
                        {"position", api::json(marker.position)},
                        {"heading", rounded(marker.heading)},
                        {"scale", api::json(marker.scale)},
                        {"color", json(marker.color)},
                        {"points", flat(marker.points)},
                        {"colors", hex_of(marker.colors)},
                        {"point_count", api::json(marker.point_count)},
                        {"text", api::json(marker.text)},
                        {"mesh", api::json(marker.mesh)},
                        {"lifetime", api::json(marker.lifetime)},
                        {"at", api::json(row.at)}}};
}

/// Five numbers: a track has thousands of them.
Value json(const TrackPose& pose) {
  return {Value::Array{rounded(pose.at), rounded(pose.position.x), rounded(pose.position.y),
                       rounded(pose.position.z), rounded(pose.heading)}};
}

template <class Each>
Value array_of(const Each& each) {
  Value::Array array;
  array.reserve(each.size());
  for (const auto& one : each) array.push_back(json(one));
  return {std::move(array)};
}

}  // namespace

std::string write_markers(const MarkerChanges& changes) {
  Value::Array gone;
  for (const auto& [ns, id] : changes.gone) {
    gone.push_back({Value::Object{{"ns", api::json(ns)}, {"id", api::json(id)}}});
  }
  return codec::write_json({Value::Object{{"version", api::json(changes.version)},
                                          {"whole", api::json(changes.whole)},
                                          {"left_out", api::json(changes.left_out)},
                                          {"markers", array_of(changes.markers)},
                                          {"gone", {std::move(gone)}}}});
}

std::string write_tracks(const std::vector<Track>& tracks) {
  Value::Array all;
  for (const Track& track : tracks) {
    all.push_back({Value::Object{{"robot", api::json(track.robot)}, {"poses", array_of(track.poses)}}});
  }
  return codec::write_json({Value::Object{{"tracks", {std::move(all)}}}});
}

}  // namespace adit::api
