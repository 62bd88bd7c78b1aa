#include <algorithm>
#include <cmath>
#include <cstring>

#include "codec/gzip.hpp"
#include "codec/messages.hpp"
#include "icd/sentence.hpp"

namespace adit::codec::test {
namespace {

std::size_t below(Random& random, std::size_t end) {
  return random() % end;
}

/// Mostly small, for speed. Sometimes large enough for several chunks.
std::size_t any_size(Random& random, std::size_t end) {
  return below(random, below(random, 8) == 0 ? end : end / 8);
}

/// Any finite double of any magnitude, often a whole number.
double any_number(Random& random) {
  if (below(random, 4) == 0) return static_cast<double>(below(random, 2001)) - 1000;
  double number = NAN;
  while (!std::isfinite(number)) {
    const std::uint64_t bits = random();
    std::memcpy(&number, &bits, sizeof number);
  }
  return number;
}

icd::Point any_point(Random& random) {
  return {any_number(random), any_number(random), any_number(random)};
}

icd::Pose any_pose(Random& random) {
  return {.position = any_point(random),
          .orientation =
              icd::rotation_of({any_number(random), any_number(random), any_number(random), 0.5}).value()};
}

/// Often `last`.
double any_time(Random& random, double last) {
  return std::min(std::abs(any_number(random)), last);
}

icd::Header any_header(Random& random) {
  if (below(random, 3) == 0) return {};
  return {.stamp = any_time(random, icd::kLatestStamp)};
}

icd::RobotName any_name(Random& random) {
  static constexpr std::string_view kLetters = "abcXYZ019_";
  std::string text;
  for (std::size_t i = 0, size = 1 + below(random, 10); i < size; ++i) text += kLetters[below(random, 10)];
  return *icd::RobotName::parse(text);
}

/// UTF-8 sequences of every length, quotation marks, control characters.
std::string any_text(Random& random) {
  static const std::vector<std::string> kPieces = {
      "a", "Z", " ", "\"", "\\", "\n", "\x01", "/", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\xa4\x96"};
  std::string text;
  for (std::size_t i = 0, size = below(random, 40); i < size; ++i)
    text += kPieces[below(random, kPieces.size())];
  return text;
}

double fraction(Random& random) {
  return static_cast<double>(below(random, 1001)) / 1000;
}

icd::Color any_color(Random& random) {
  return {fraction(random), fraction(random), fraction(random), fraction(random)};
}

/// Adds members of a marker that the ICD does not list.
void add_geometry(icd::Marker& marker, Random& random) {
  marker.frame_locked = below(random, 2) == 0;
  marker.points.resize(any_size(random, 200));
  for (icd::Point& point : marker.points) point = any_point(random);
  if (below(random, 2) == 0) marker.colors.resize(marker.points.size());
  for (icd::Color& color : marker.colors) color = any_color(random);
  if (below(random, 3) == 0) marker.mesh_resource = any_text(random);
  marker.mesh_use_embedded_materials = below(random, 2) == 0;
}

}  // namespace

icd::MapUpdate random_grid(Random& random) {
  icd::OccupancyGrid grid;
  grid.header = any_header(random);
  grid.resolution = 0.001 + fraction(random);
  grid.width = static_cast<std::uint32_t>(1 + any_size(random, 480));
  grid.height = static_cast<std::uint32_t>(1 + any_size(random, 320));
  grid.origin = any_pose(random);
  Bytes cells(std::size_t{grid.width} * grid.height, icd::kUnknownCell);
  for (std::size_t i = below(random, 50); i < cells.size(); i += 1 + below(random, 20)) {
    cells[i] = static_cast<std::uint8_t>(below(random, 101));
  }
  icd::MapUpdate update{.name = any_name(random), .msg = grid, .data = {}};
  if (below(random, 4) == 0) update.name.reset();
  update.data = {.bytes = gzip(icd::ChunkedBytes(cells), GzipStrategy::Runs),
                 .compression = icd::Compression::Gzip,
                 .raw_size = cells.size()};
  return update;
}

icd::MapUpdate random_cloud(Random& random) {
  icd::PointCloud2 cloud;
  cloud.header = any_header(random);
  if (below(random, 3) != 0) cloud.origin = any_pose(random);
  cloud.is_bigendian = below(random, 2) == 0;
  const auto coordinate = below(random, 2) == 0 ? icd::Datatype::Float32 : icd::Datatype::Float64;
  const auto add = [&](std::string name, icd::Datatype datatype, std::uint32_t count) {
    cloud.point_step += static_cast<std::uint32_t>(below(random, 5));  // padding
    cloud.fields.push_back({std::move(name), cloud.point_step, datatype, count});
    cloud.point_step += static_cast<std::uint32_t>(icd::size_of(datatype)) * count;
  };
  for (const char* name : {"x", "y", "z"}) add(name, coordinate, 1);
  for (std::size_t i = 0, size = below(random, 5); i < size; ++i) {
    add(icd::sentence(any_text(random), "!"), static_cast<icd::Datatype>(1 + below(random, 8)),
        static_cast<std::uint32_t>(1 + below(random, 4)));
  }
  Bytes points(any_size(random, 2400) * cloud.point_step);
  for (auto& byte : points) byte = static_cast<std::uint8_t>(random());
  icd::MapUpdate update{.name = any_name(random), .msg = cloud, .data = {}};
  if (below(random, 4) == 0) update.name.reset();
  update.data = {.bytes = icd::ChunkedBytes(points), .compression = {}, .raw_size = points.size()};
  if (below(random, 2) == 0) {
    update.data.bytes = gzip(std::move(update.data.bytes), GzipStrategy::Default);
    update.data.compression = icd::Compression::Gzip;
  }
  return update;
}

icd::StateUpdate random_state(Random& random) {
  icd::StateUpdate update{.header = any_header(random), .poses = {}};
  for (std::size_t i = 0, size = below(random, 12); i < size; ++i) {
    const auto name = *icd::RobotName::parse(icd::sentence("r", i));
    update.poses.push_back({.name = name, .pose = any_pose(random)});
  }
  return update;
}

icd::MarkersUpdate random_markers(Random& random) {
  static constexpr icd::MarkerAction kActions[] = {icd::MarkerAction::Add, icd::MarkerAction::Delete,
                                                   icd::MarkerAction::DeleteAll};
  icd::MarkersUpdate update;
  for (std::size_t i = 0, size = below(random, 12); i < size; ++i) {
    update.markers.push_back({.header = any_header(random),
                              .ns = "n" + any_text(random),
                              .id = static_cast<std::int32_t>(random()),
                              .type = static_cast<std::int32_t>(below(random, 12)),
                              .action = kActions[below(random, 3)],
                              .pose = any_pose(random),
                              .scale = any_point(random),
                              .color = any_color(random),
                              .lifetime = any_time(random, icd::kLongestLifetime),
                              .text = any_text(random)});
    if (below(random, 2) == 0) add_geometry(update.markers.back(), random);
  }
  return update;
}

}  // namespace adit::codec::test
