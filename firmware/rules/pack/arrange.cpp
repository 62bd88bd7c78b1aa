#include "pack/arrange.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include "codec/gzip_whole.hpp"
#include "pack/coordinates.hpp"
#include "pack/point_layout.hpp"
#include "pack/point_order.hpp"
#include "pack/points.hpp"

namespace adit::pack {
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
std::size_t tried(std::span<const std::uint8_t> points, std::size_t step,
                  std::span<const std::uint32_t> numbers) {
  constexpr std::size_t kShare = 32, kShareOfFew = 4, kStretches = 16, kTelling = std::size_t{32} << 10;
  const std::size_t bytes = std::max(points.size() / kShare, std::min(points.size() / kShareOfFew, kTelling));
  const std::size_t part = numbers.size() / kStretches;
  Bytes some;
  for (std::size_t i = 0; i < kStretches; ++i) {
    gather(points, step, numbers.subspan(i * part, std::min(part, bytes / kStretches / step + 1)), some);
  }
  const auto member = codec::gzip_whole(some, kPointsLevel, some.size());
  return member ? member->size() : some.size();
}

/// Orders at most kMostOrdered points.
void put_block_in_order(const icd::PointCloud2& cloud, const Box& box, std::span<std::uint8_t> points) {
  const std::size_t step = cloud.point_step;
  Numbers best(points.size() / step);
  std::iota(best.begin(), best.end(), 0U);
  std::size_t smallest = tried(points, step, best);
  for (const Layers layers : {Layers::AlongZ, Layers::AlongY, Layers::AlongX}) {
    Numbers other = numbers_in(layers, cloud, box, points);
    const std::size_t size = tried(points, step, other);
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

Arranged in_one_piece(const PointLayout& layout, const icd::MapData& data, std::size_t point_step) {
  const std::size_t step = layout.cloud.point_step;
  Arranged arranged{.cloud = layout.cloud, .points = Bytes(data.bytes.size() / point_step * step)};
  std::span<std::uint8_t> rest{arranged.points};
  for_each_point(data.bytes, point_step, [&](std::span<const std::uint8_t> point) {
    layout.copy(point, rest);
    rest = rest.subspan(step);
    return true;
  });
  return arranged;
}

Box box_of(const Arranged& arranged) {
  const CoordinateReader coordinates{arranged.cloud};
  const std::size_t step = arranged.cloud.point_step;
  Box box;
  std::span<const std::uint8_t> points{arranged.points};
  for (; points.size() >= step; points = points.subspan(step)) box.add(coordinates(points.first(step)));
  return box;
}

/// Works in blocks of equal size.
void put_in_order(Arranged& arranged) {
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

}  // namespace adit::pack
