#include "pack/points.hpp"

#include <algorithm>
#include <string_view>

namespace adit::pack {

FiniteCheck::FiniteCheck(const icd::PointCloud2& cloud) {
  std::size_t axis = 0;
  for (const std::string_view name : {"x", "y", "z"}) {
    const auto field = std::ranges::find(cloud.fields, name, &icd::FieldSchema::name);
    const std::size_t size = icd::size_of(field->datatype);
    low_bits_ = field->datatype == icd::Datatype::Float64 ? 0xf0 : 0x80;
    const std::size_t first = field->offset, last = field->offset + size - 1;
    exponents_[axis++] = cloud.is_bigendian ? Exponent{first, first + 1} : Exponent{last, last - 1};
  }
}

}  // namespace adit::pack
