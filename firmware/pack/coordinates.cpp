#include "pack/coordinates.hpp"

#include <algorithm>
#include <string_view>

#include "icd/require.hpp"

namespace adit::pack {

CoordinateReader::CoordinateReader(const icd::PointCloud2& cloud) : is_bigendian_(cloud.is_bigendian) {
  std::size_t axis = 0;
  for (const std::string_view name : {"x", "y", "z"}) {
    const auto field = std::ranges::find(cloud.fields, name, &icd::FieldSchema::name);
    icd::require(field != cloud.fields.end());
    is_double_ = field->datatype == icd::Datatype::Float64;  // all three are
    offsets_[axis++] = field->offset;
  }
}

}  // namespace adit::pack
