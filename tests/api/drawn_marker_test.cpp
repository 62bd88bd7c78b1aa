#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "api/scene.hpp"

namespace adit::api {
namespace {

using icd::MarkerType;
using testing::ElementsAre;
using testing::Field;
using testing::FloatNear;
using testing::IsEmpty;
using testing::SizeIs;

icd::Marker marker(MarkerType type, std::vector<icd::Point> points = {}) {
  icd::Marker marker;
  marker.type = static_cast<std::int32_t>(type);
  marker.points = std::move(points);
  marker.scale = {1, 1, 1};
  return marker;
}

std::vector<icd::Point> along_x(std::size_t count, double step = 1) {
  std::vector<icd::Point> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({static_cast<double>(i) * step, 0, 0});
  return points;
}

auto near(double x, double y) {
  return AllOf(Field(&FlatPoint::x, FloatNear(static_cast<float>(x), 1e-4F)),
               Field(&FlatPoint::y, FloatNear(static_cast<float>(y), 1e-4F)));
}

TEST(DrawnMarker, AppliesThePoseToItsPoints) {
  icd::Marker line = marker(MarkerType::LineStrip, {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}});
  line.pose.position = {10, 20, 5};
  const double half = std::numbers::pi / 4;
  line.pose.orientation = {0, 0, std::sin(half), std::cos(half)};  // a quarter turn to the left
  EXPECT_THAT(draw_marker(line).points, ElementsAre(near(10, 21), near(8, 20), near(10, 20)));
  EXPECT_NEAR(draw_marker(line).heading, 2 * half, 1e-9);
  line.pose.orientation = {0, std::sin(half), 0, std::cos(half)};  // about y: z goes to x
  EXPECT_THAT(draw_marker(line).points, ElementsAre(near(10, 20), near(10, 22), near(13, 20)));
  EXPECT_EQ(draw_marker(line).point_count, 3u);
}

TEST(DrawnMarker, HasPointsOnlyIfItsShapeUsesThem) {
  for (const auto type : {MarkerType::Cube, MarkerType::Sphere, MarkerType::Cylinder,
                          MarkerType::TextViewFacing, MarkerType::MeshResource}) {
    EXPECT_THAT(draw_marker(marker(type, along_x(5))).points, IsEmpty());
  }
  EXPECT_THAT(draw_marker(marker(MarkerType::Arrow, along_x(1))).points, IsEmpty())
      << "an arrow with one point uses its pose";
  EXPECT_THAT(draw_marker(marker(MarkerType::Arrow, along_x(3))).points, ElementsAre(near(0, 0), near(1, 0)));
  EXPECT_THAT(draw_marker(marker(MarkerType::LineList, along_x(5))).points, SizeIs(4))
      << "a line has two ends";
  EXPECT_THAT(draw_marker(marker(MarkerType::TriangleList, along_x(8))).points, SizeIs(6));
}

TEST(DrawnMarker, ScalesOnlyCornersOfTriangles) {
  for (const auto type : {MarkerType::TriangleList, MarkerType::LineStrip}) {
    icd::Marker each = marker(type, {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}});
    each.scale = {3, 0, 1};
    const double times = type == MarkerType::TriangleList ? 3 : 1;
    EXPECT_THAT(draw_marker(each).points,
                ElementsAre(near(times, 1), near(2 * times, 1), near(2 * times, 2)));
  }
}

TEST(DrawnMarker, ThinsAMarkerWithTooManyPoints) {
  for (const auto type : {MarkerType::LineStrip, MarkerType::LineList, MarkerType::CubeList,
                          MarkerType::SphereList, MarkerType::Points, MarkerType::TriangleList}) {
    const auto shown = draw_marker(marker(type, along_x(icd::kMostMarkerPoints - 1)));
    EXPECT_LE(shown.points.size(), DrawnMarker::kMostPoints) << static_cast<int>(type);
    EXPECT_GT(shown.points.size(), DrawnMarker::kMostPoints * 9 / 10) << static_cast<int>(type);
    EXPECT_GE(shown.point_count, icd::kMostMarkerPoints - 3);
  }
  const auto pairs = draw_marker(marker(MarkerType::LineList, along_x(50'000)));
  EXPECT_EQ(pairs.points[3].x, pairs.points[2].x + 1) << "a line lost an end";
}

TEST(DrawnMarker, ThinsAStripAlongItsLengthAndKeepsItsEnds) {
  auto points = along_x(20'000, 0);  // the robot stood still for long
  for (const auto& point : along_x(5000)) points.push_back(point);
  const auto shown = draw_marker(marker(MarkerType::LineStrip, points));
  EXPECT_THAT(shown.points.front(), near(0, 0));
  EXPECT_THAT(shown.points.back(), near(4999, 0));
  for (std::size_t i = 1; i < shown.points.size(); ++i) {
    ASSERT_LE(shown.points[i].x - shown.points[i - 1].x, 7) << "a long way is left out at " << i;
  }
  EXPECT_THAT(draw_marker(marker(MarkerType::LineStrip, along_x(5000, 0))).points, SizeIs(2))
      << "a line without movement has two points";
}

TEST(DrawnMarker, HasAColourForEachRemainingPart) {
  auto list = marker(MarkerType::LineList, along_x(4));
  list.colors = {{1, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {0, 1, 0, 1}};
  EXPECT_THAT(draw_marker(list).colors, ElementsAre(icd::Color{1, 0, 0, 1}, icd::Color{0, 1, 0, 1}));
  auto triangles = marker(MarkerType::TriangleList, along_x(6));
  triangles.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  EXPECT_THAT(draw_marker(triangles).colors, ElementsAre(icd::Color{1, 0, 0, 1}, icd::Color{0, 1, 0, 1}));
  auto points = marker(MarkerType::Points, along_x(5000));
  for (int i = 0; i < 5000; ++i) points.colors.push_back({i / 5000.0, 0, 0, 1});
  const auto shown = draw_marker(points);
  ASSERT_EQ(shown.colors.size(), shown.points.size());
  for (std::size_t i = 0; i < shown.points.size(); ++i) {
    EXPECT_NEAR(shown.colors[i].r, shown.points[i].x / 5000.0, 1e-6);
  }
  EXPECT_THAT(draw_marker(marker(MarkerType::Points, along_x(5))).colors, IsEmpty());
}

TEST(DrawnMarker, DropsColoursWhoseCountDoesNotFit) {
  for (const auto type : {MarkerType::LineStrip, MarkerType::LineList, MarkerType::Points, MarkerType::Arrow,
                          MarkerType::TriangleList}) {
    auto odd = marker(type, along_x(9));
    for (const std::size_t colors : {1, 2, 4, 8, 10}) {
      odd.colors.assign(colors, {1, 0, 0, 1});
      EXPECT_THAT(draw_marker(odd).colors, IsEmpty()) << colors << " of type " << static_cast<int>(type);
    }
  }
}

/// Points that alternate between two corners of space.
std::vector<icd::Point> between(double far, std::size_t count) {
  std::vector<icd::Point> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({i % 2 == 0 ? far : -far, -far, far});
  return points;
}

TEST(DrawnMarker, IsBoundedAndFiniteAtAnyDistance) {
  for (const double far : {1e30, 1e39, 1e200, 1e308}) {
    for (const auto type : {MarkerType::LineStrip, MarkerType::LineList, MarkerType::TriangleList}) {
      auto each = marker(type, between(far, 5000));
      each.pose.position = {-far, far, far};
      each.pose.orientation = {0.5, -0.5, 0.5, 0.5};
      each.scale = {far, far, 0};
      const auto shown = draw_marker(each);
      EXPECT_LE(shown.points.size(), DrawnMarker::kMostPoints) << far;
      EXPECT_GE(shown.points.size(), DrawnMarker::kMostPoints / 2) << far;
      for (const FlatPoint& point : shown.points) {
        ASSERT_TRUE(std::isfinite(point.x) && std::isfinite(point.y)) << far;
      }
      EXPECT_TRUE(std::isfinite(shown.heading)) << far;
    }
  }
}

TEST(DrawnMarker, LimitsItsText) {
  icd::Marker mesh = marker(MarkerType::MeshResource);
  for (const auto& [url, name] : {std::pair{"package://artifacts/meshes/fire.ext.dae", "fire.ext"},
                                  {"file:///drill", "drill"},
                                  {"", ""},
                                  {".hidden", ".hidden"},
                                  {"a/", ""}}) {
    mesh.mesh_resource = url;
    EXPECT_EQ(draw_marker(mesh).mesh, name) << url;
  }
  mesh.text = std::string(119, 'a') + "\u00e9" + std::string(9000, 'b');
  EXPECT_EQ(draw_marker(mesh).text, std::string(119, 'a')) << "the text is cut within a character";
}

}  // namespace
}  // namespace adit::api
