#include "api/map_scene.hpp"

#include <cmath>
#include <cstring>
#include <utility>

#include "icd/xyz.hpp"

namespace adit::api {
namespace {

constexpr int kSide = 480;  // cells of half a metre: 240 m

/// The distance of a place from the centre of a winding tunnel towards +X, or of its branch towards +Y.
double off_the_way(double x, double y) {
  const double main = std::abs(y - 40 - 12 * std::sin(x / 23));
  const double branch = y < 40 ? 1e9 : std::abs(x - 130 - 9 * std::sin(y / 17));
  return std::min(main, branch);
}

/// The part of the cave that is known after `reach` metres.
icd::MapUpdate explored(double reach) {
  icd::OccupancyGrid grid;
  grid.width = grid.height = kSide;
  grid.resolution = 0.5;
  grid.origin.position = {-10, -30, 0};
  std::vector<std::uint8_t> cells;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int column = i % kSide, row = i / kSide;
    const double x = column * 0.5, y = row * 0.5, off = off_the_way(x, y);
    const bool seen = x + std::max(0.0, y - 60) < reach && off < 4;
    cells.push_back(!seen ? icd::kUnknownCell : off < 3.2 ? std::uint8_t{0} : icd::kMostOccupied);
  }
  icd::MapUpdate map{{}, grid, {}};
  map.data.raw_size = cells.size();
  map.data.bytes = icd::ChunkedBytes{cells};
  return map;
}

icd::MapUpdate scanned(double reach) {
  std::vector<float> values;
  for (double x = 0; x < reach; x += 0.2) {
    for (double across = -3; across <= 3; across += 0.2) {
      values.push_back(static_cast<float>(x - 10));
      values.push_back(static_cast<float>(10 + 12 * std::sin(x / 23) + across));
      values.push_back(static_cast<float>(x / 40 + 0.1 * across * across));
    }
  }
  const icd::PointCloud2 cloud = icd::xyz();
  std::vector<std::uint8_t> bytes(values.size() * sizeof(float));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  icd::MapUpdate map{icd::RobotName::parse("ugv1"), cloud, {}};
  map.data.raw_size = bytes.size();
  map.data.bytes = icd::ChunkedBytes{bytes};
  return map;
}

void draw(picture::Mosaic& map, const icd::MapUpdate& update, double stamp) {
  if (auto drawing = picture::draw(update, map.canvas(picture::layer_of(update)))) {
    map.apply(std::move(*drawing), stamp);
  }
}

}  // namespace

void draw_scene(picture::Mosaic& map, double now) {
  constexpr int kSteps = 20;
  for (int step = 1; step <= kSteps; ++step) {
    const double stamp = now - 30.0 * (kSteps - step), reach = 240.0 * step / kSteps;
    draw(map, explored(reach), stamp - 1);
    draw(map, scanned(reach), stamp);
  }
}

/// Points around the marker's pose, for types that are made of points.
std::vector<icd::Point> points_of(icd::MarkerType type) {
  std::vector<icd::Point> points;
  switch (type) {
    case icd::MarkerType::LineStrip:
      for (int i = 0; i < 3000; ++i) points.push_back({i / 100.0, 2 * std::sin(i / 400.0), 0});
      return points;
    case icd::MarkerType::TriangleList:
      return {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 0, 0}, {2, 3, 0}, {0, 3, 0}};
    case icd::MarkerType::LineList:
    case icd::MarkerType::CubeList:
    case icd::MarkerType::SphereList:
    case icd::MarkerType::Points:
      for (const double x : {0.0, 2.5, 5.0}) points.insert(points.end(), {{x, 0, 0}, {x, 3, 0}});
      return points;
    default:
      return {};
  }
}

icd::Marker scene_marker(icd::MarkerType type) {
  icd::Marker marker;
  marker.ns = "scene";
  marker.id = marker.type = static_cast<std::int32_t>(type);
  const double x = marker.type * 10.0;
  marker.pose.position = {x, 40 + 12 * std::sin(x / 23) + 6, 0};
  marker.pose.orientation = {0, 0, 0.38, 0.92};
  marker.scale = {4, 2, 2};
  marker.color = {1, 0.2, 1, 1};
  marker.points = points_of(type);
  if (!marker.points.empty()) marker.scale = {1, 1, 1};
  if (marker.is(icd::MarkerType::LineStrip)) marker.scale.x = 0.3;
  if (marker.is(icd::MarkerType::LineList)) marker.scale.x = 0.6;
  if (marker.is(icd::MarkerType::SphereList)) {
    for (int i = 0; i < 6; ++i) marker.colors.push_back({i / 6.0, 0.4, 1, 1});
  }
  marker.text = marker.is(icd::MarkerType::TextViewFacing) ? "camp" : "";
  marker.mesh_resource =
      marker.is(icd::MarkerType::MeshResource) ? "package://artifacts/meshes/drill.dae" : "";
  return marker;
}

MarkerChanges scene_markers(double now) {
  MarkerChanges changes{.version = 1, .whole = true, .left_out = 3, .markers = {}, .gone = {}};
  for (std::int32_t type = 0; type <= icd::kLastMarkerType; ++type) {
    changes.markers.push_back(
        {draw_marker(scene_marker(static_cast<icd::MarkerType>(type))), now - 300 + type});
  }
  changes.markers[2].marker.color.a = 0;
  changes.markers[1].marker.lifetime = 10;
  icd::Marker arrow = scene_marker(icd::MarkerType::Arrow);
  arrow.id = 20;
  arrow.points = {{0, -8, 0}, {6, -8, 0}};
  arrow.scale = {0.4, 1.5, 1.5};
  changes.markers.push_back({draw_marker(arrow), now - 280});
  return changes;
}

std::vector<Track> scene_tracks(double now) {
  std::vector<Track> tracks = {{"ANYmal1", {}}, {"Scout", {}}};
  for (int i = 0; i < 600; ++i) {
    const double x = i / 600.0 * 100;
    tracks[0].poses.push_back({now - 600 + i, {x, 40 + 12 * std::sin(x / 23), 0}, 0.3});
    tracks[1].poses.push_back({now - 600 + i, {x * 0.7, 38 + 12 * std::sin(x * 0.7 / 23), 4}, 0.3});
  }
  return tracks;
}

}  // namespace adit::api
