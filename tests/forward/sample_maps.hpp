#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "codec/gzip.hpp"
#include "icd/mapping.hpp"
#include "icd/xyz.hpp"

namespace adit::forward {

/// A cloud with points on the x axis; "": without a robot.
inline icd::MapUpdate cloud_along_x(const char* robot, const std::vector<float>& xs) {
  const icd::PointCloud2 cloud = icd::xyz();
  std::vector<std::uint8_t> bytes(12 * xs.size());
  for (std::size_t i = 0; i < xs.size(); ++i) std::memcpy(bytes.data() + 12 * i, &xs[i], sizeof xs[i]);
  return {
      icd::RobotName::parse(robot), cloud, {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()}};
}

inline icd::MapUpdate grid_of(const std::string& robot, std::uint32_t side, std::uint8_t value = 1,
                              double x = 0, double resolution = 0.25) {
  icd::OccupancyGrid grid;
  grid.header.stamp = 1;
  grid.resolution = resolution;
  grid.width = grid.height = side;
  grid.origin.position.x = x;
  const std::vector<std::uint8_t> cells(std::size_t{side} * side, value);
  return {
      icd::RobotName::parse(robot), grid, {icd::ChunkedBytes{cells}, icd::Compression::None, cells.size()}};
}

/// The x of each point of such a cloud, compressed or not.
inline std::vector<float> xs_of(const icd::MapData& data) {
  std::vector<std::uint8_t> bytes;
  (void)codec::for_each_piece(data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    return {};
  });
  std::vector<float> xs(bytes.size() / 12);
  for (std::size_t i = 0; i < xs.size(); ++i) std::memcpy(&xs[i], bytes.data() + 12 * i, sizeof xs[i]);
  return xs;
}

}  // namespace adit::forward
