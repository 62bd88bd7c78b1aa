#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "icd/mapping.hpp"
#include "icd/xyz.hpp"
#include "queues/map_queue.hpp"
#include "queues/state_queue.hpp"

namespace adit::queues {

/// `seconds` after the beginning of simulated time.
inline Instant at(double seconds) {
  return Instant{std::chrono::duration_cast<Instant::duration>(std::chrono::duration<double>{seconds})};
}

/// "": a merged map.
inline std::optional<icd::RobotName> robot(std::string_view name) {
  return icd::RobotName::parse(name);
}

/// The poses of one client's state, with its stamp.
inline std::vector<PostedPose> posted(const icd::StateUpdate& update,
                                      const std::string& address = "10.0.0.5") {
  std::vector<PostedPose> poses;
  for (const icd::NamedPose& named : update.poses) {
    const auto& stamp = update.header.stamp;
    poses.push_back({named.name, named.pose, stamp, stamp ? address : ""});
  }
  return poses;
}

inline icd::OccupancyGrid grid(double x, double y, std::uint32_t width, std::uint32_t height,
                               double resolution = 0.05) {
  icd::OccupancyGrid grid;
  grid.resolution = resolution;
  grid.width = width;
  grid.height = height;
  grid.origin.position = {x, y, 0};
  return grid;
}

/// The queue ignores the data.
inline icd::MapUpdate grid_update(std::string_view name, const icd::OccupancyGrid& grid) {
  icd::MapData data{icd::ChunkedBytes{std::vector<std::uint8_t>{1, 2, 3}}, icd::Compression::Gzip, 0};
  data.raw_size = std::size_t{grid.width} * grid.height;
  return {robot(name), grid, data};
}

/// One point for each element of `points`. All twelve bytes of a point have that value.
inline icd::MapUpdate cloud_update(std::string_view name, const std::vector<std::uint8_t>& points,
                                   const icd::PointCloud2& cloud = icd::xyz()) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint8_t point : points) bytes.insert(bytes.end(), 12, point);
  return {robot(name), cloud, {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()}};
}

inline std::vector<std::uint8_t> points_of(const icd::MapUpdate& update) {
  std::vector<std::uint8_t> points;
  const auto bytes = update.data.bytes.to_vector();
  for (std::size_t i = 0; i < bytes.size(); i += 12) points.push_back(bytes[i]);
  return points;
}

}  // namespace adit::queues
