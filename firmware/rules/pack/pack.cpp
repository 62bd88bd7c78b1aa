#include "pack/pack.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "codec/gzip.hpp"
#include "pack/arrange.hpp"
#include "pack/points.hpp"

namespace adit::pack {
namespace {

/// Another effort may take at most this part of the time.
constexpr double kWorthIt = 0.9;

double seconds_per_byte(Effort effort) {
  return kSecondsPerByte[static_cast<std::size_t>(effort)];
}

/// Appends `size` bytes from `at` on.
void append(std::vector<std::uint8_t>& to, const icd::ChunkedBytes& bytes, std::size_t at, std::size_t size) {
  for (const auto& chunk : bytes.chunks()) {
    const std::size_t before = std::min(at, chunk->size());
    const auto some = chunk->subspan(before, std::min(size, chunk->size() - before));
    to.insert(to.end(), some.begin(), some.end());
    at -= before;
    size -= some.size();
    if (size == 0) return;
  }
}

/// The size to which Quick compresses a byte, measured on a sample of the points.
double sampled_ratio(const icd::ChunkedBytes& points) {
  constexpr std::size_t kShare = 32, kTelling = std::size_t{64} << 10, kStretches = 16;
  const std::size_t size = std::min(points.size(), std::max(points.size() / kShare, kTelling));
  std::vector<std::uint8_t> some;
  some.reserve(size);
  for (std::size_t i = 0; i < kStretches; ++i) {
    append(some, points, points.size() / kStretches * i, size / kStretches);
  }
  if (some.empty()) return 1;
  const auto member = codec::gzip(some, codec::kFastestLevel, some.size());
  return member ? static_cast<double>(member->size()) / static_cast<double>(some.size()) : 1;
}

/// True if the cells are not worth their memory. Measured: a byte of a stored cave holds 35 to 220 cells, but
/// only 2 to 20 if libdeflate can make it much smaller.
bool is_left(const icd::MapData& cells) {
  constexpr std::size_t kMany = std::size_t{16} << 20, kPerByte = 40;
  return cells.raw_size > kMany && cells.bytes.size() <= cells.raw_size / kPerByte;
}

Effort effort_for_grid(const icd::MapUpdate& grid, const EffortInput& hurry) {
  if (is_left(grid.data)) return Effort::None;
  const double as_stored = static_cast<double>(grid.data.bytes.size()) / hurry.bytes_per_second;
  const double most = std::min({hurry.longest / 2, 0.5, as_stored});
  for (const Effort effort : {Effort::Full, Effort::Quick}) {
    if (hurry.slowness * seconds_for(effort, grid) <= most) return effort;
  }
  return Effort::None;
}

}  // namespace

Effort effort_for(std::size_t size, double quick_to, const EffortInput& hurry) {
  const double bytes = static_cast<double>(size);
  struct Cost {
    double delay, takes;  // seconds, of all maps and of this one
    auto operator<=>(const Cost&) const = default;
  };
  const auto cost = [&](Effort effort, double to) -> Cost {
    const double packs = hurry.slowness * seconds_per_byte(effort) * bytes;
    const double leaves = to * bytes / hurry.bytes_per_second;
    return {std::max({packs, leaves, hurry.longest}), packs + leaves};
  };
  Cost least = cost(Effort::Full, quick_to * kFullOfQuick);
  least.takes *= kWorthIt;
  Effort best = Effort::Full;
  for (const auto& [effort, to] : {std::pair{Effort::Quick, quick_to}, std::pair{Effort::None, 1.0}}) {
    const Cost other = cost(effort, to);
    if (other > least) continue;
    least = other;
    best = effort;
  }
  return best;
}

/// If even a cloud that Quick shrinks to nothing is best sent uncompressed, no sample is tried.
Choice effort_for(const icd::MapUpdate& map, const EffortInput& hurry) {
  if (map.data.raw_size > kMostPacked) return {Effort::None};
  if (map.is_grid()) return {effort_for_grid(map, hurry)};
  const std::size_t size = map.data.bytes.size();
  if (effort_for(size, 0, hurry) == Effort::None) return {Effort::None};
  const double quick_to = sampled_ratio(map.data.bytes);
  return {effort_for(size, quick_to, hurry), quick_to * kFullOfQuick};
}

/// Measured: the maximum over all grids. A high level takes its time for the bytes of the stored form.
double seconds_for(Effort effort, const icd::MapUpdate& map) {
  const double size = static_cast<double>(map.data.raw_size);
  if (!map.is_grid()) return seconds_per_byte(effort) * size;
  // The longest times measured: random cells of 16 values, any cell, and a kept byte of three random values.
  constexpr double kQuickPerCell = 17e-9, kFullPerCell = 5e-9, kFullPerKeptByte = 2.5e-6;
  if (effort == Effort::None) return 0;
  if (effort == Effort::Quick) return kQuickPerCell * size;
  return kFullPerCell * size + kFullPerKeptByte * static_cast<double>(map.data.bytes.size());
}

namespace {

/// Makes uncompressed, finite points as small as `form` allows, and sets the cloud's layout to match. If two
/// fields share bytes, the points are only gzipped.
void pack_points(icd::PointCloud2& cloud, icd::MapData& data, const CloudForm& form) {
  if (data.bytes.empty() || form.effort == Effort::None) return;
  const bool is_full = form.effort == Effort::Full;
  const auto tight = form.is_arranged ? strip_padding(cloud) : std::nullopt;
  const PointLayout layout = tight ? *tight : plain_layout(cloud);
  ContiguousCloud arranged = arrange_contiguous(layout, data, cloud.point_step);
  if (tight && is_full && form.unit > 0) round_to(form.unit, arranged);
  if (tight && is_full) put_in_order(arranged);
  const int level = is_full ? kPointsLevel : codec::kFastestLevel;
  auto member = codec::gzip(arranged.points, level, arranged.points.size() - 1);
  if (!member && layout.cloud == cloud) return;
  if (!member) arranged = arrange_contiguous(layout, data, cloud.point_step);  // exact and in their order
  cloud = std::move(arranged.cloud);
  data.raw_size = arranged.points.size();
  data.compression = member ? icd::Compression::Gzip : icd::Compression::None;
  data.bytes = member ? *std::move(member) : icd::ChunkedBytes{arranged.points};
}

/// Checks that x, y and z are finite by their exponents (IEEE 754), without alignment or byte swapping.
class FiniteCheck {
 public:
  explicit FiniteCheck(const icd::PointCloud2& cloud) {
    std::size_t axis = 0;
    for (const std::string_view name : {"x", "y", "z"}) {
      const icd::FieldSchema& field = icd::field_of(cloud, name);
      low_bits_ = field.datatype == icd::Datatype::Float64 ? 0xf0 : 0x80;
      const std::size_t first = field.offset, last = first + icd::size_of(field.datatype) - 1;
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
  const auto cells = codec::gunzip(data.bytes, data.raw_size);
  if (!cells) return std::nullopt;
  const int level = effort == Effort::Full ? kCellsLevel : kQuickCellsLevel;
  const std::size_t smallest = std::min(cells->size(), data.bytes.size());
  if (auto member = codec::gzip(*cells, level, smallest - 1)) {
    data.bytes = *std::move(member);
  } else if (smallest == cells->size()) {
    return icd::MapData{icd::ChunkedBytes(*cells), icd::Compression::None, cells->size()};
  }
  return data;
}

icd::MapData remove_invalid_points(const icd::PointCloud2& cloud, icd::MapData data) {
  const FiniteCheck is_finite{cloud};
  bool all_are = true;
  for_each_point(data.bytes, cloud.point_step, [&](auto point) { return all_are = is_finite(point); });
  if (all_are) return data;
  return filter_points(data, cloud.point_step, is_finite);
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
  map.data = remove_invalid_points(cloud, std::move(map.data));
  pack_points(cloud, map.data, form);
  return map;
}

}  // namespace adit::pack
