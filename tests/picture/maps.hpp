#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "codec/gzip.hpp"
#include "picture/mosaic.hpp"

namespace adit::picture {

using Cells = std::vector<std::uint8_t>;

constexpr std::uint8_t kUnknown = icd::kUnknownCell;

inline icd::Quaternion turned_by(double yaw) {
  return {0, 0, std::sin(yaw / 2), std::cos(yaw / 2)};
}

inline icd::MapUpdate with_data(icd::MapUpdate map, const std::vector<std::uint8_t>& bytes) {
  map.data.raw_size = bytes.size();
  map.data.bytes = icd::ChunkedBytes{bytes};
  return map;
}

inline icd::MapUpdate gzipped(icd::MapUpdate map) {
  map.data.bytes = codec::gzip(std::move(map.data.bytes), codec::GzipStrategy::Runs);
  map.data.compression = icd::Compression::Gzip;
  return map;
}

/// Cells row by row from the lower left.
inline icd::MapUpdate grid_of(std::uint32_t width, double resolution, icd::Pose origin, const Cells& cells) {
  icd::OccupancyGrid grid;
  grid.width = width;
  grid.height = static_cast<std::uint32_t>(cells.size() / width);
  grid.resolution = resolution;
  grid.origin = origin;
  return with_data({icd::RobotName::parse("ugv1"), grid, {}}, cells);
}

inline icd::MapUpdate grid_at(double x, double y, std::uint32_t width, double resolution,
                              const Cells& cells) {
  return grid_of(width, resolution, {.position = {x, y, 0}, .orientation = {}}, cells);
}

inline icd::MapUpdate cloud_of(const std::vector<icd::Point>& points, std::optional<icd::Pose> origin = {}) {
  icd::PointCloud2 cloud;
  cloud.fields = {{"x", 0, icd::Datatype::Float64, 1},
                  {"y", 8, icd::Datatype::Float64, 1},
                  {"z", 16, icd::Datatype::Float64, 1}};
  cloud.point_step = 24;
  cloud.origin = origin;
  std::vector<std::uint8_t> bytes(points.size() * sizeof(icd::Point));
  if (!points.empty()) std::memcpy(bytes.data(), points.data(), bytes.size());
  return with_data({icd::RobotName::parse("ugv1"), cloud, {}}, bytes);
}

/// Draws one map per second, and reads pixels.
class Easel {
 public:
  explicit Easel(std::size_t budget = Mosaic::kBudget) : mosaic(budget) {}

  Drawing draw(const icd::MapUpdate& map) {
    auto drawing = picture::draw(map, mosaic.canvas(layer_of(map)));
    EXPECT_TRUE(drawing) << drawing.error().sentence;
    if (!drawing) return {};
    layer = layer_of(map);
    EXPECT_TRUE(mosaic.apply(*drawing, ++now));
    return *std::move(drawing);
  }

  Pixels pixels(const TileIndex& at, std::optional<double> stamp = {}) {
    Pixels pixels{};
    if (const auto shown = mosaic.tile(layer, at, stamp); shown.tile) packer_.unpack(*shown.tile, pixels);
    return pixels;
  }

  /// The index of a pixel of a level, counted from the frame's origin.
  int pixel(int level, int x, int y, std::optional<double> stamp = {}) {
    const TileIndex at{level, x >> 8, y >> 8};
    if (!(at == looked_at_) || stamp != looked_when_ || mosaic.version() != looked_version_) {
      looked_ = pixels(at, stamp);
      looked_at_ = at, looked_when_ = stamp, looked_version_ = mosaic.version();
    }
    return looked_[index_of(x & 255, y & 255)];
  }
  /// The index at a place in metres.
  int seen(double x, double y, int level = 0, std::optional<double> stamp = {}) {
    const double scale = kMetresPerPixel[static_cast<std::size_t>(level)];
    return pixel(level, static_cast<int>(std::floor(x / scale)), static_cast<int>(std::floor(y / scale)),
                 stamp);
  }

  Mosaic mosaic;
  Layer layer;  // of the last map
  double now = 1000;

 private:
  Packer packer_;
  Pixels looked_{};
  TileIndex looked_at_{-1, 0, 0};
  std::optional<double> looked_when_;
  std::uint64_t looked_version_ = 0;
};

constexpr int kFree = 1, kOccupied = 101;  // indices of cells of 0 and 100

}  // namespace adit::picture
