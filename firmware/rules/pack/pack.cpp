#include "pack/pack.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "codec/gzip_whole.hpp"
#include "pack/arrange.hpp"
#include "pack/point_layout.hpp"
#include "pack/points.hpp"
#include "pack/rounding.hpp"

namespace adit::pack {
namespace {

/// Makes uncompressed, finite points as small as `form` allows, and sets the cloud's layout to match. If two
/// fields share bytes, the points are only gzipped.
void pack_points(icd::PointCloud2& cloud, icd::MapData& data, const CloudForm& form) {
  if (data.bytes.empty() || form.effort == Effort::None) return;
  const bool is_full = form.effort == Effort::Full;
  const auto tight = form.is_arranged ? without_padding(cloud) : std::nullopt;
  const PointLayout layout = tight ? *tight : unchanged(cloud);
  Arranged arranged = in_one_piece(layout, data, cloud.point_step);
  if (tight && is_full && form.unit > 0) round_to(form.unit, arranged);
  if (tight && is_full) put_in_order(arranged);
  const int level = is_full ? kPointsLevel : codec::kFastestLevel;
  auto member = codec::gzip_whole(arranged.points, level, arranged.points.size() - 1);
  if (!member && layout.cloud == cloud) return;
  if (!member) arranged = in_one_piece(layout, data, cloud.point_step);  // exact and in their order
  cloud = std::move(arranged.cloud);
  data.raw_size = arranged.points.size();
  data.compression = member ? icd::Compression::Gzip : icd::Compression::None;
  data.bytes = member ? *std::move(member) : icd::ChunkedBytes{arranged.points};
}

/// Checks that a point's x, y and z are finite, by their exponents only (IEEE 754). It needs no alignment and
/// no byte swapping.
class FiniteCheck {
 public:
  explicit FiniteCheck(const icd::PointCloud2& cloud) {
    std::size_t axis = 0;
    for (const std::string_view name : {"x", "y", "z"}) {
      const auto field = std::ranges::find(cloud.fields, name, &icd::FieldSchema::name);
      const std::size_t size = icd::size_of(field->datatype);
      low_bits_ = field->datatype == icd::Datatype::Float64 ? 0xf0 : 0x80;
      const std::size_t first = field->offset, last = field->offset + size - 1;
      exponents_[axis++] = cloud.is_bigendian ? Exponent{first, first + 1} : Exponent{last, last - 1};
    }
  }

  bool operator()(std::span<const std::uint8_t> point) const {
    for (const Exponent& exponent : exponents_) {
      if ((point[exponent.high] & kHighBits) == kHighBits && (point[exponent.low] & low_bits_) == low_bits_) {
        return false;  // infinite or not a number: all bits of the exponent are set
      }
    }
    return true;
  }

 private:
  struct Exponent {
    std::size_t high = 0, low = 0;  // offsets of its two bytes in a point
  };
  static constexpr std::uint8_t kHighBits = 0x7f;
  std::uint8_t low_bits_ = 0;  // 1 bit in a float32, 4 in a float64
  std::array<Exponent, 3> exponents_;
};

}  // namespace

std::optional<icd::MapData> pack_cells(icd::MapData data, Effort effort) {
  if (effort == Effort::None || data.compression == icd::Compression::None) return data;
  const auto cells = codec::gunzip_whole(data.bytes, data.raw_size);
  if (!cells) return std::nullopt;
  const int level = effort == Effort::Full ? kCellsLevel : kQuickCellsLevel;
  const std::size_t smallest = std::min(cells->size(), data.bytes.size());
  if (auto member = codec::gzip_whole(*cells, level, smallest - 1)) {
    data.bytes = *std::move(member);
  } else if (smallest == cells->size()) {
    return icd::MapData{icd::ChunkedBytes(*cells), icd::Compression::None, cells->size()};
  }
  return data;
}

icd::MapData without_invalid_points(const icd::PointCloud2& cloud, icd::MapData data) {
  const FiniteCheck is_finite{cloud};
  bool all_are = true;
  for_each_point(data.bytes, cloud.point_step, [&](auto point) { return all_are = is_finite(point); });
  if (all_are) return data;
  return those_that_stay(data, cloud.point_step, is_finite);
}

bool has_only_invalid_points(const icd::MapUpdate& map) {
  const auto* const cloud = std::get_if<icd::PointCloud2>(&map.msg);
  if (cloud == nullptr || map.data.compression != icd::Compression::None || map.data.bytes.empty())
    return false;
  const FiniteCheck is_finite{*cloud};
  bool none_is = true;
  for_each_point(map.data.bytes, cloud->point_step, [&](auto point) { return none_is = !is_finite(point); });
  return none_is;
}

icd::MapUpdate pack(icd::MapUpdate map, const CloudForm& form) {
  if (map.data.compression != icd::Compression::None) return map;
  auto& cloud = std::get<icd::PointCloud2>(map.msg);
  map.data = without_invalid_points(cloud, std::move(map.data));
  pack_points(cloud, map.data, form);
  return map;
}

}  // namespace adit::pack
