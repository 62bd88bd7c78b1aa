#include "pack/points.hpp"

#include <algorithm>
#include <cstring>

#include "icd/require.hpp"

namespace adit::pack {

/// check(cloud) makes sure that all three have one datatype.
CoordinateReader::CoordinateReader(const icd::PointCloud2& cloud)
    : offsets_(icd::axes_of(cloud)),
      is_double_(icd::field_of(cloud, "x").datatype == icd::Datatype::Float64),
      is_bigendian_(cloud.is_bigendian) {}

void PointLayout::copy(std::span<const std::uint8_t> point, std::span<std::uint8_t> to) const {
  for (const Run& run : runs) std::memcpy(to.data() + run.to, point.data() + run.from, run.size);
}

PointLayout plain_layout(const icd::PointCloud2& cloud) {
  return {.cloud = cloud, .runs = {{.from = 0, .to = 0, .size = cloud.point_step}}};
}

std::optional<PointLayout> strip_padding(const icd::PointCloud2& cloud) {
  PointLayout layout{.cloud = cloud, .runs = {}};
  std::vector<icd::FieldSchema*> fields;
  fields.reserve(cloud.fields.size());
  for (icd::FieldSchema& field : layout.cloud.fields) fields.push_back(&field);
  std::ranges::sort(fields, {}, [](const icd::FieldSchema* field) { return field->offset; });
  std::uint32_t begin = 0, end = 0;  // of the next new field; of the previous old field
  for (icd::FieldSchema* field : fields) {
    const std::uint64_t size = std::uint64_t{icd::size_of(field->datatype)} * field->count;
    icd::require(size <= cloud.point_step && field->offset <= cloud.point_step - size);
    if (field->offset < end) return std::nullopt;
    const bool goes_on = !layout.runs.empty() && field->offset == end;
    if (!goes_on) layout.runs.push_back({.from = field->offset, .to = begin, .size = 0});
    layout.runs.back().size += static_cast<std::uint32_t>(size);
    end = field->offset + static_cast<std::uint32_t>(size);
    field->offset = begin;
    begin += static_cast<std::uint32_t>(size);
  }
  layout.cloud.point_step = begin;
  return layout;
}

}  // namespace adit::pack
