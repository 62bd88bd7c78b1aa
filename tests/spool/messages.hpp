#pragma once

#include "icd/mapping.hpp"
#include "icd/xyz.hpp"

namespace adit::spool {

/// Small messages of each kind, for tests that store them.
inline icd::StateUpdate state() {
  return {.header = {.stamp = 7.5}, .poses = {{*icd::RobotName::parse("r2"), {}}}};
}

inline icd::MarkersUpdate markers() {
  icd::Marker marker;
  marker.ns = "path";
  marker.color.a = 1;
  return {.markers = {marker}};
}

/// A cloud of that many points; neighbours differ.
inline icd::MapUpdate cloud(std::size_t points) {
  icd::PointCloud2 cloud = icd::xyz();
  cloud.header.stamp = 5;
  cloud.origin = icd::Pose{};
  std::vector<std::uint8_t> bytes(points * 12);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 >> 8);
  return {
      icd::RobotName::parse("r1"), cloud, {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()}};
}

}  // namespace adit::spool
