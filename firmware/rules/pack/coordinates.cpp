#include "pack/coordinates.hpp"

#include <string_view>

#include "icd/require.hpp"

namespace adit::pack {
namespace {

const icd::FieldSchema& field_of(const icd::PointCloud2& cloud, std::string_view name) {
  const auto field = std::ranges::find(cloud.fields, name, &icd::FieldSchema::name);
  icd::require(field != cloud.fields.end());
  return *field;
}

}  // namespace

std::array<std::size_t, 3> axes_of(const icd::PointCloud2& cloud) {
  return {field_of(cloud, "x").offset, field_of(cloud, "y").offset, field_of(cloud, "z").offset};
}

/// check(cloud) makes sure that all three have one datatype.
CoordinateReader::CoordinateReader(const icd::PointCloud2& cloud)
    : offsets_(axes_of(cloud)),
      is_double_(field_of(cloud, "x").datatype == icd::Datatype::Float64),
      is_bigendian_(cloud.is_bigendian) {}

}  // namespace adit::pack
