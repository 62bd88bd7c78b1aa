#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::pack {

using Bytes = std::vector<std::uint8_t>;

/// A layout of a point: x, y and z anywhere within it, a byte "tag" at its end.
struct Layout {
  const char* what;
  icd::Datatype datatype;
  bool big_endian;
  std::uint32_t x, y, z, step;
};

inline constexpr Layout kLayouts[] = {
    {"plain float32", icd::Datatype::Float32, false, 0, 4, 8, 13},
    {"float32, big-endian", icd::Datatype::Float32, true, 0, 4, 8, 13},
    {"float64", icd::Datatype::Float64, false, 0, 8, 16, 25},
    {"float64, big-endian", icd::Datatype::Float64, true, 0, 8, 16, 25},
    {"padded, in another order, unaligned", icd::Datatype::Float32, false, 17, 1, 9, 40},
    {"float64, padded, in another order", icd::Datatype::Float64, true, 32, 5, 16, 48},
    {"larger than a chunk", icd::Datatype::Float32, false, 0, 70'000, 140'000, 200'001},
};

inline icd::PointCloud2 cloud_of(const Layout& layout) {
  icd::PointCloud2 cloud;
  cloud.fields = {{"tag", layout.step - 1, icd::Datatype::Uint8, 1},
                  {"z", layout.z, layout.datatype, 1},
                  {"x", layout.x, layout.datatype, 1},
                  {"y", layout.y, layout.datatype, 1}};
  cloud.is_bigendian = layout.big_endian;
  cloud.point_step = layout.step;
  return cloud;
}

template <class Float>
void put(Bytes& point, std::uint32_t offset, Float value, bool big_endian) {
  auto* to = point.data() + offset;
  std::memcpy(to, &value, sizeof value);
  if (big_endian) std::reverse(to, to + sizeof value);
}

inline Bytes point_of(const Layout& layout, double x, double y, double z, std::uint8_t tag) {
  Bytes point(layout.step, 0xff);  // padding that would be NaN
  for (const auto& [offset, value] : {std::pair{layout.x, x}, {layout.y, y}, {layout.z, z}}) {
    if (layout.datatype == icd::Datatype::Float32) {
      put(point, offset, static_cast<float>(value), layout.big_endian);
    } else {
      put(point, offset, value, layout.big_endian);
    }
  }
  point.back() = tag;
  return point;
}

/// The same bytes in chunks of random sizes.
inline icd::MapData cut_up(const Bytes& bytes, std::mt19937_64& random) {
  icd::MapData data;
  data.raw_size = bytes.size();
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t longest = std::min<std::size_t>(bytes.size() - at, icd::ChunkedBytes::kChunk);
    const auto size = std::uniform_int_distribution<std::size_t>{1, longest}(random);
    data.bytes.append(Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                            bytes.begin() + static_cast<std::ptrdiff_t>(at + size)));
    at += size;
  }
  return data;
}

}  // namespace adit::pack
