#include "pack/arrange.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/gzip.hpp"
#include "icd/geometry.hpp"
#include "icd/require.hpp"
#include "pack/points.hpp"

namespace adit::pack {
namespace {

/// A point's rank and, in the lowest bits, its number. So one word is sorted for each point.
using Key = std::uint64_t;
constexpr unsigned kNumberBits = 20, kDigitBits = 11, kDigits = 4;
static_assert(kMostOrdered <= std::size_t{1} << kNumberBits);
static_assert(kNumberBits + kDigitBits * kDigits == 64);

/// Converts a coordinate to whole steps between the lowest and the highest.
class Steps {
 public:
  Steps(double low, double extent, unsigned bits)
      : low_(low), most_(static_cast<double>((1u << bits) - 1)), per_metre_(most_ / extent) {}

  /// 0 if the coordinate is out of range or the steps cannot be computed.
  Key key_of(double metres) const {
    const double steps = (metres - low_) * per_metre_;
    return steps >= 0 && steps <= most_ ? static_cast<Key>(steps) : 0;
  }

 private:
  double low_, most_, per_metre_;
};

std::vector<Key> keys_of(Layers layers, const icd::PointCloud2& cloud, const Box& box,
                         std::span<const std::uint8_t> points) {
  constexpr unsigned kBitsOfFirst = 22, kBitsOfOthers = 11;
  const std::size_t first = static_cast<std::size_t>(layers), second = (first + 2) % 3,
                    third = (first + 1) % 3;
  const auto steps = [&box](std::size_t axis, unsigned bits) {
    return Steps{box.low[axis], box.high[axis] - box.low[axis], bits};
  };
  const Steps of_first = steps(first, kBitsOfFirst), of_second = steps(second, kBitsOfOthers),
              of_third = steps(third, kBitsOfOthers);
  const CoordinateReader coordinates{cloud};
  std::vector<Key> keys(points.size() / cloud.point_step);
  for (std::size_t number = 0; number < keys.size(); ++number) {
    const Coordinates at = coordinates(points.subspan(number * cloud.point_step, cloud.point_step));
    Key key = of_first.key_of(at[first]);
    key = key << kBitsOfOthers | of_second.key_of(at[second]);
    key = key << kBitsOfOthers | of_third.key_of(at[third]);
    keys[number] = key << kNumberBits | number;
  }
  return keys;
}

/// Radix sort by all bits except the number's: stable, from the lowest digit up (Knuth, The Art of Computer
/// Programming 3, 5.2.5). A digit that all keys share takes no pass.
void sort(std::vector<Key>& keys) {
  constexpr std::size_t kValues = std::size_t{1} << kDigitBits;
  const auto digit = [](Key key, unsigned number) {
    return key >> (kNumberBits + number * kDigitBits) & (kValues - 1);
  };
  std::array<std::array<std::uint32_t, kValues>, kDigits> counts{};
  for (const Key key : keys) {
    for (unsigned number = 0; number < kDigits; ++number) ++counts[number][digit(key, number)];
  }
  std::vector<Key> sorted(keys.size());
  for (unsigned number = 0; number < kDigits; ++number) {
    auto& places = counts[number];
    if (places[digit(keys.front(), number)] == keys.size()) continue;
    std::uint32_t next = 0;
    for (std::uint32_t& place : places) next += std::exchange(place, next);
    for (const Key key : keys) sorted[places[digit(key, number)]++] = key;
    keys.swap(sorted);
  }
}

}  // namespace

std::vector<std::uint32_t> numbers_in(Layers layers, const icd::PointCloud2& cloud, const Box& box,
                                      std::span<const std::uint8_t> points) {
  icd::require(points.size() / cloud.point_step <= kMostOrdered);
  if (points.size() < cloud.point_step) return {};
  std::vector<Key> sorted = keys_of(layers, cloud, box, points);
  sort(sorted);
  std::vector<std::uint32_t> numbers(sorted.size());
  std::ranges::transform(sorted, numbers.begin(), [](Key key) {
    return static_cast<std::uint32_t>(key & ((Key{1} << kNumberBits) - 1));
  });
  return numbers;
}

namespace {

using Numbers = std::vector<std::uint32_t>;
using Bytes = std::vector<std::uint8_t>;

void gather(std::span<const std::uint8_t> points, std::size_t step, std::span<const std::uint32_t> numbers,
            Bytes& to) {
  for (const std::uint32_t number : numbers) {
    const auto point = points.subspan(number * step, step);
    to.insert(to.end(), point.begin(), point.end());
  }
}

/// The size to which gzip compresses a sample of the points in that order.
std::size_t compressed_size(std::span<const std::uint8_t> points, std::size_t step,
                            std::span<const std::uint32_t> numbers) {
  constexpr std::size_t kShare = 32, kShareOfFew = 4, kStretches = 16, kTelling = std::size_t{32} << 10;
  const std::size_t bytes = std::max(points.size() / kShare, std::min(points.size() / kShareOfFew, kTelling));
  const std::size_t part = numbers.size() / kStretches;
  Bytes some;
  for (std::size_t i = 0; i < kStretches; ++i) {
    gather(points, step, numbers.subspan(i * part, std::min(part, bytes / kStretches / step + 1)), some);
  }
  const auto member = codec::gzip(some, kPointsLevel, some.size());
  return member ? member->size() : some.size();
}

/// Orders at most kMostOrdered points.
void put_block_in_order(const icd::PointCloud2& cloud, const Box& box, std::span<std::uint8_t> points) {
  const std::size_t step = cloud.point_step;
  Numbers best(points.size() / step);
  std::iota(best.begin(), best.end(), 0U);
  std::size_t smallest = compressed_size(points, step, best);
  for (const Layers layers : {Layers::AlongZ, Layers::AlongY, Layers::AlongX}) {
    Numbers other = numbers_in(layers, cloud, box, points);
    const std::size_t size = compressed_size(points, step, other);
    if (size >= smallest) continue;
    smallest = size;
    best = std::move(other);
  }
  Bytes ordered;
  ordered.reserve(points.size());
  gather(points, step, best, ordered);
  std::ranges::copy(ordered, points.begin());
}

}  // namespace

ContiguousCloud arrange_contiguous(const PointLayout& layout, const icd::MapData& data,
                                   std::size_t point_step) {
  const std::size_t step = layout.cloud.point_step;
  ContiguousCloud arranged{.cloud = layout.cloud, .points = Bytes(data.bytes.size() / point_step * step)};
  std::span<std::uint8_t> rest{arranged.points};
  for_each_point(data.bytes, point_step, [&](std::span<const std::uint8_t> point) {
    layout.copy(point, rest);
    rest = rest.subspan(step);
    return true;
  });
  return arranged;
}

Box box_of(const ContiguousCloud& arranged) {
  const CoordinateReader coordinates{arranged.cloud};
  const std::size_t step = arranged.cloud.point_step;
  Box box;
  std::span<const std::uint8_t> points{arranged.points};
  for (; points.size() >= step; points = points.subspan(step)) box.add(coordinates(points.first(step)));
  return box;
}

/// Works in blocks of equal size.
void put_in_order(ContiguousCloud& arranged) {
  const std::size_t step = arranged.cloud.point_step, points = arranged.points.size() / step;
  const std::size_t blocks = (points + kMostOrdered - 1) / kMostOrdered;
  if (blocks == 0) return;
  const Box box = box_of(arranged);
  const std::size_t size = (points + blocks - 1) / blocks * step;
  std::span<std::uint8_t> rest{arranged.points};
  while (!rest.empty()) {
    const auto block = rest.first(std::min(rest.size(), size));
    put_block_in_order(arranged.cloud, box, block);
    rest = rest.subspan(block.size());
  }
}

namespace {

/// Fields whose values do not change when the cloud is turned.
constexpr std::string_view kUnturned[] = {"intensity", "i",    "rgb", "rgba",      "ring",  "reflectivity",
                                          "label",     "time", "t",   "timestamp", "range", "ambient"};

bool is_coordinate(const icd::FieldSchema& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

bool can_rotate(const icd::PointCloud2& cloud) {
  return std::ranges::all_of(cloud.fields, [](const icd::FieldSchema& field) {
    return is_coordinate(field) || std::ranges::find(kUnturned, field.name) != std::end(kUnturned);
  });
}

/// The box that holds all corners of the placed `box`.
Box placed_box(const Box& box, const icd::Placement& placed) {
  Box all;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto end = [&](unsigned axis) {
      return (corner >> axis & 1) != 0 ? box.high[axis] : box.low[axis];
    };
    const icd::Point at = placed({end(0), end(1), end(2)});
    all.add({at.x, at.y, at.z});
  }
  return all;
}

/// Leads from the points' frame into the binade; `origin` leads from there to "darpa".
struct Shift {
  icd::Placement placed;
  icd::Point origin;
};

/// Moves one coordinate of `placed` so that `low` to `high` lie in the binade. False if it is too narrow or
/// float32 too coarse in "darpa". `origin` is a float32, so a receiver rounds only once, adding the two.
bool shift(double binade, double unit, double low, double high, double& placed, double& origin) {
  constexpr double kMargin = 4;  // units; the origin is rounded by at most one
  if (!(std::max(std::abs(low), std::abs(high)) < binade)) return false;
  origin = static_cast<double>(static_cast<float>(low - binade - kMargin * unit));
  placed -= origin;
  return low - origin >= binade && high - origin <= 2 * binade - unit;
}

std::optional<Shift> shift_of(const icd::PointCloud2& cloud, const Box& box, double unit) {
  const icd::Pose origin = cloud.origin.value_or(icd::Pose{});
  if (origin.orientation.is_turned() && !can_rotate(cloud)) return std::nullopt;
  Shift found{.placed = icd::Placement{origin}, .origin = {}};
  const Box all = placed_box(box, found.placed);
  const double binade = 0x1p23 * unit;
  icd::Point& by = found.placed.shift;
  const bool fits = shift(binade, unit, all.low[0], all.high[0], by.x, found.origin.x) &&
                    shift(binade, unit, all.low[1], all.high[1], by.y, found.origin.y) &&
                    shift(binade, unit, all.low[2], all.high[2], by.z, found.origin.z);
  return fits ? std::optional(found) : std::nullopt;
}

icd::PointCloud2 to_float32(icd::PointCloud2 cloud) {
  for (icd::FieldSchema& field : cloud.fields) {
    if (is_coordinate(field)) field.datatype = icd::Datatype::Float32;
  }
  return cloud;
}

/// Works in place, because the new points are not larger.
void shift_points(ContiguousCloud& arranged, const PointLayout& layout, const icd::Placement& placed) {
  const CoordinateReader coordinates{arranged.cloud};
  const auto axes = icd::axes_of(layout.cloud);
  const std::size_t step = arranged.cloud.point_step, new_step = layout.cloud.point_step;
  std::vector<std::uint8_t> point(step);
  std::size_t end = 0;  // of the new points
  for (std::size_t from = 0; from < arranged.points.size(); from += step) {
    std::memcpy(point.data(), arranged.points.data() + from, step);
    const std::span<std::uint8_t> to = std::span{arranged.points}.subspan(end, new_step);
    layout.copy(point, to);
    const auto [x, y, z] = coordinates(point);
    const icd::Point at = placed({x, y, z});
    for (const auto& [metres, axis] : {std::pair{at.x, axes[0]}, {at.y, axes[1]}, {at.z, axes[2]}}) {
      const auto rounded = static_cast<float>(metres);
      std::memcpy(to.data() + axis, &rounded, sizeof rounded);
    }
    end += new_step;
  }
  arranged.points.resize(end);
}

}  // namespace

bool round_to(double unit, ContiguousCloud& arranged) {
  if (arranged.cloud.is_bigendian || arranged.points.empty()) return false;
  const auto layout = strip_padding(to_float32(arranged.cloud));
  const auto shift = shift_of(arranged.cloud, box_of(arranged), unit);
  if (!layout || !shift) return false;
  shift_points(arranged, *layout, shift->placed);
  arranged.cloud = layout->cloud;
  arranged.cloud.origin = icd::Pose{.position = shift->origin, .orientation = {}};
  return true;
}

}  // namespace adit::pack
