#pragma once

#include "icd/mapping.hpp"

namespace adit::icd {

/// Points with x, y and z in float32 without gaps, as most robots send them.
inline PointCloud2 xyz() {
  PointCloud2 cloud;
  cloud.fields = {
      {"x", 0, Datatype::Float32, 1}, {"y", 4, Datatype::Float32, 1}, {"z", 8, Datatype::Float32, 1}};
  cloud.point_step = 12;
  return cloud;
}

}  // namespace adit::icd
