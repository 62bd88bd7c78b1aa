#include "sizes_bounds.hpp"

#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace adit::bench {
namespace {

constexpr double kStep = 0x1p-10;  // metres
using Bytes = std::vector<std::uint8_t>;

bool is_coordinate(const icd::FieldSchema& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

template <class Number>
Number read(const std::uint8_t* at) {
  Number number{};
  std::memcpy(&number, at, sizeof number);
  return number;
}

/// In steps.
std::int64_t coordinate(const icd::FieldSchema& field, const std::uint8_t* point) {
  const std::uint8_t* const at = point + field.offset;
  const double metres = field.datatype == icd::Datatype::Float64 ? read<double>(at) : read<float>(at);
  return std::isfinite(metres) ? std::llround(metres / kStep) : 0;
}

std::int64_t integer(icd::Datatype datatype, const std::uint8_t* at) {
  switch (datatype) {
    case icd::Datatype::Int8:
      return read<std::int8_t>(at);
    case icd::Datatype::Uint8:
      return read<std::uint8_t>(at);
    case icd::Datatype::Int16:
      return read<std::int16_t>(at);
    case icd::Datatype::Uint16:
      return read<std::uint16_t>(at);
    case icd::Datatype::Int32:
      return read<std::int32_t>(at);
    default:
      return read<std::uint32_t>(at);
  }
}

bool is_float(icd::Datatype datatype) {
  return datatype == icd::Datatype::Float32 || datatype == icd::Datatype::Float64;
}

void put(std::int64_t difference, Bytes& to) {
  auto left = static_cast<std::uint64_t>(difference) << 1 ^ static_cast<std::uint64_t>(difference >> 63);
  for (; left >= 0x80; left >>= 7) to.push_back(static_cast<std::uint8_t>(left | 0x80));
  to.push_back(static_cast<std::uint8_t>(left));
}

/// Of one point, each value as the difference to that of the point before.
void put_point(const icd::PointCloud2& cloud, const std::uint8_t* point, std::vector<std::int64_t>& before,
               Bytes& to) {
  std::size_t place = 0;
  const auto put_next = [&](std::int64_t value) {
    if (place == before.size()) before.push_back(0);
    put(value - before[place], to);
    before[place++] = value;
  };
  for (const icd::FieldSchema& field : cloud.fields) {
    const std::size_t size = icd::size_of(field.datatype);
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const std::uint8_t* const at = point + field.offset + i * size;
      if (is_coordinate(field))
        put_next(coordinate(field, point));
      else if (is_float(field.datatype))
        to.insert(to.end(), at, at + size);
      else
        put_next(integer(field.datatype, at));
    }
  }
}

/// A field's bits, as an attribute of integers.
int add_attribute(const icd::FieldSchema& field, draco::PointCloudBuilder& builder) {
  const std::size_t size = icd::size_of(field.datatype);
  const draco::DataType kind = size == 1 ? draco::DT_UINT8 : size == 2 ? draco::DT_UINT16 : draco::DT_UINT32;
  const auto count = static_cast<std::int8_t>(field.count * (size == 8 ? 2 : 1));
  return builder.AddAttribute(draco::GeometryAttribute::GENERIC, count, kind);
}

struct Fields {
  std::array<const icd::FieldSchema*, 3> axes{};
  std::vector<std::pair<const icd::FieldSchema*, int>> others;  // and the number of the attribute

  Fields(const icd::PointCloud2& cloud, draco::PointCloudBuilder& builder) {
    for (const icd::FieldSchema& field : cloud.fields) {
      if (is_coordinate(field))
        axes.at(static_cast<std::size_t>(field.name[0] - 'x')) = &field;
      else
        others.emplace_back(&field, add_attribute(field, builder));
    }
  }
  std::array<float, 3> position(const std::uint8_t* point) const {
    const auto metres = [&](std::size_t axis) {
      return static_cast<float>(static_cast<double>(coordinate(*axes[axis], point)) * kStep);
    };
    return {metres(0), metres(1), metres(2)};
  }
};

/// Of the smallest box along the axes that holds all points.
struct Sides {
  std::array<float, 3> low{1e30F, 1e30F, 1e30F}, high{-1e30F, -1e30F, -1e30F};

  void add(const std::array<float, 3>& at) {
    for (std::size_t axis = 0; axis < at.size(); ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
  }
  double longest() const {
    double longest = 0;
    for (std::size_t axis = 0; axis < low.size(); ++axis)
      longest = std::max(longest, static_cast<double>(high[axis]) - static_cast<double>(low[axis]));
    return longest;
  }
};

draco::Encoder draco_encoder(const Sides& sides) {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(5, 5);
  encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
  const int bits = std::max(1, static_cast<int>(std::ceil(std::log2(sides.longest() / kStep + 1))));
  encoder.SetAttributeExplicitQuantization(draco::GeometryAttribute::POSITION, bits, 3, sides.low.data(),
                                           static_cast<float>(std::exp2(bits) * kStep));
  return encoder;
}

}  // namespace

std::size_t by_differences_and_zstd(const icd::MapUpdate& map) {
  const auto& cloud = std::get<icd::PointCloud2>(map.msg);
  const Bytes points = map.data.bytes.to_vector();
  Bytes coded;
  coded.reserve(points.size());
  std::vector<std::int64_t> before;
  for (std::size_t at = 0; at + cloud.point_step <= points.size(); at += cloud.point_step)
    put_point(cloud, points.data() + at, before, coded);
  Bytes member(ZSTD_compressBound(coded.size()));
  return ZSTD_compress(member.data(), member.size(), coded.data(), coded.size(), 1);
}

std::size_t by_draco(const icd::MapUpdate& map) {
  const auto& cloud = std::get<icd::PointCloud2>(map.msg);
  const Bytes points = map.data.bytes.to_vector();
  const auto count = static_cast<std::uint32_t>(points.size() / cloud.point_step);
  draco::PointCloudBuilder builder;
  builder.Start(count);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const Fields fields(cloud, builder);
  Sides sides;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint8_t* const point = points.data() + std::size_t{i} * cloud.point_step;
    const std::array<float, 3> at = fields.position(point);
    sides.add(at);
    builder.SetAttributeValueForPoint(position, draco::PointIndex(i), at.data());
    for (const auto& [field, attribute] : fields.others)
      builder.SetAttributeValueForPoint(attribute, draco::PointIndex(i), point + field->offset);
  }
  draco::Encoder encoder = draco_encoder(sides);
  draco::EncoderBuffer buffer;
  const auto made = builder.Finalize(false);
  return encoder.EncodePointCloudToBuffer(*made, &buffer).ok() ? buffer.size() : 0;
}

}  // namespace adit::bench
