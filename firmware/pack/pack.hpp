#pragma once

#include <cstddef>

#include "icd/map_update.hpp"

namespace adit::pack {

/// A map as small as it can be made without loss, ready to be written: a cloud loses the points that are not
/// finite (ICD 6.3.2 takes clouds to be dense), and what is not compressed yet is gzipped where that is
/// smaller. CPU-bound in the size of the map: meant for a worker.
icd::MapUpdate pack(icd::MapUpdate map);

/// `data` without the points whose x, y or z is not finite. `data` must be uncompressed.
icd::MapData without_invalid_points(const icd::PointCloud2& cloud, icd::MapData data);

}  // namespace adit::pack
