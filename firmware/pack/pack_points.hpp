#pragma once

#include "icd/map_update.hpp"
#include "pack/pack.hpp"

namespace adit::pack {

/// Makes finite points that are not compressed as small as `form` lets it be, and their cloud says how they
/// lie then. Where two fields share bytes, all is left as it is but for gzip.
void pack_points(icd::PointCloud2& cloud, icd::MapData& data, const CloudForm& form);

}  // namespace adit::pack
