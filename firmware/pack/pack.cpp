#include "pack/pack.hpp"

#include <utility>
#include <variant>

#include "codec/gzip.hpp"
#include "pack/points.hpp"

namespace adit::pack {
namespace {

icd::MapData compressed(icd::MapData data, codec::GzipStrategy strategy) {
  icd::ChunkedBytes member = codec::gzip(data.bytes, strategy);
  if (member.size() >= data.bytes.size()) return data;
  data.bytes = std::move(member);
  data.compression = icd::Compression::Gzip;
  return data;
}

}  // namespace

icd::MapData without_invalid_points(const icd::PointCloud2& cloud, icd::MapData data, std::size_t& dropped) {
  const FiniteCheck is_finite{cloud};
  dropped = 0;
  for_each_point(data.bytes, cloud.point_step, [&](auto point) { dropped += is_finite(point) ? 0 : 1; });
  if (dropped == 0) return data;

  icd::MapData kept;
  for_each_point(data.bytes, cloud.point_step, [&](auto point) {
    if (is_finite(point)) kept.bytes.append(point);
  });
  kept.raw_size = kept.bytes.size();
  return kept;
}

icd::MapUpdate pack(icd::MapUpdate map) {
  if (map.data.compression != icd::Compression::None) return map;
  const auto* cloud = std::get_if<icd::PointCloud2>(&map.msg);
  if (cloud == nullptr) {
    map.data = compressed(std::move(map.data), codec::GzipStrategy::Runs);
    return map;
  }
  std::size_t dropped = 0;
  map.data =
      compressed(without_invalid_points(*cloud, std::move(map.data), dropped), codec::GzipStrategy::Default);
  return map;
}

}  // namespace adit::pack
