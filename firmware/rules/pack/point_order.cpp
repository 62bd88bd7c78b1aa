#include "pack/point_order.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "icd/require.hpp"
#include "pack/coordinates.hpp"

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
  Key of(double metres) const {
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
    Key key = of_first.of(at[first]);
    key = key << kBitsOfOthers | of_second.of(at[second]);
    key = key << kBitsOfOthers | of_third.of(at[third]);
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

}  // namespace adit::pack
