#pragma once

#include "icd/map_update.hpp"
#include "pack/pack.hpp"

namespace adit::pack {

/// Makes uncompressed, finite points as small as `form` allows, and sets the cloud's layout to match. If two
/// fields share bytes, the points are only gzipped.
void pack_points(icd::PointCloud2& cloud, icd::MapData& data, const CloudForm& form);

}  // namespace adit::pack
