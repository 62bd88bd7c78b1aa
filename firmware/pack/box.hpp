#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "pack/coordinates.hpp"

namespace adit::pack {

/// The smallest axis-parallel box around some points. Without points its low is above its high.
struct Box {
  Coordinates low = all(std::numeric_limits<double>::max()),
              high = all(std::numeric_limits<double>::lowest());

  void add(const Coordinates& point) {
    for (std::size_t axis = 0; axis < point.size(); ++axis) {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }

 private:
  static Coordinates all(double metres) { return {metres, metres, metres}; }
};

}  // namespace adit::pack
