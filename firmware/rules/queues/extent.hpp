#pragma once

#include <algorithm>
#include <limits>

#include "icd/map_update.hpp"

namespace adit::queues {

/// A rectangle along the axes of the frame that grids are posted in ("darpa"), in metres.
struct Extent {
  double left = 0, bottom = 0, right = 0, top = 0;

  static constexpr Extent everywhere() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {-kFar, -kFar, kFar, kFar};
  }
  bool holds(const Extent& other) const {
    return left <= other.left && bottom <= other.bottom && other.right <= right && other.top <= top;
  }
  friend bool operator==(const Extent&, const Extent&) = default;
};

/// The smallest rectangle that holds both.
inline Extent around(const Extent& a, const Extent& b) {
  return {std::min(a.left, b.left), std::min(a.bottom, b.bottom), std::max(a.right, b.right),
          std::max(a.top, b.top)};
}

/// A rectangle that holds all cells of `grid` and at least one more cell on each side. It is larger if the
/// grid is rotated, and everywhere() if it has no finite bounds.
Extent extent_of(const icd::OccupancyGrid& grid);

}  // namespace adit::queues
