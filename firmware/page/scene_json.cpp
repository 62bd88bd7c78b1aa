#include <cmath>

#include "codec/json.hpp"
#include "page/as_json.hpp"
#include "page/scene.hpp"

namespace adit::page {
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

Value json(const MarkerRow& row) {
  const icd::Marker& marker = row.marker;
  return {Value::Object{{"ns", page::json(marker.ns)},
                        {"id", page::json(marker.id)},
                        {"type", page::json(marker.type)},
                        {"position", page::json(marker.pose.position)},
                        {"heading", rounded(heading_of(marker.pose.orientation))},
                        {"scale", page::json(marker.scale)},
                        {"color", json(marker.color)},
                        {"text", page::json(marker.text)},
                        {"lifetime", page::json(marker.lifetime)},
                        {"at", page::json(row.at)}}};
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

double heading_of(const icd::Quaternion& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
}

std::string write_markers(const MarkerNews& news) {
  Value::Array gone;
  for (const auto& [ns, id] : news.gone) {
    gone.push_back({Value::Object{{"ns", page::json(ns)}, {"id", page::json(id)}}});
  }
  return codec::write_json({Value::Object{{"version", page::json(news.version)},
                                          {"whole", page::json(news.whole)},
                                          {"left_out", page::json(news.left_out)},
                                          {"markers", array_of(news.markers)},
                                          {"gone", {std::move(gone)}}}});
}

std::string write_tracks(const std::vector<Track>& tracks) {
  Value::Array all;
  for (const Track& track : tracks) {
    all.push_back({Value::Object{{"robot", page::json(track.robot)}, {"poses", array_of(track.poses)}}});
  }
  return codec::write_json({Value::Object{{"tracks", {std::move(all)}}}});
}

}  // namespace adit::page
