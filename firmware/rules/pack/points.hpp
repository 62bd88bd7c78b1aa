#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/map_update.hpp"

namespace adit::pack {

/// Calls `visit` with each point of `bytes` (point_step bytes), in order, across chunk borders, until it
/// returns false.
template <class Visit>
void for_each_point(const icd::ChunkedBytes& bytes, std::size_t point_step, Visit visit) {
  std::vector<std::uint8_t> cut;  // the first bytes of a point that continues in the next chunk
  for (const auto& chunk : bytes.chunks()) {
    std::span<const std::uint8_t> rest{*chunk};
    if (!cut.empty()) {
      const auto more = rest.first(std::min(rest.size(), point_step - cut.size()));
      cut.insert(cut.end(), more.begin(), more.end());
      rest = rest.subspan(more.size());
      if (cut.size() < point_step) continue;
      if (!visit(std::span<const std::uint8_t>{cut})) return;
      cut.clear();
    }
    for (; rest.size() >= point_step; rest = rest.subspan(point_step)) {
      if (!visit(rest.first(point_step))) return;
    }
    cut.assign(rest.begin(), rest.end());
  }
}

/// The points of uncompressed `data` for which `stays` returns true, unchanged, in their order.
template <class Stays>
icd::MapData those_that_stay(const icd::MapData& data, std::size_t point_step, Stays stays) {
  icd::MapData kept;
  for_each_point(data.bytes, point_step, [&](std::span<const std::uint8_t> point) {
    if (stays(point)) kept.bytes.append(point);
    return true;
  });
  kept.raw_size = kept.bytes.size();
  return kept;
}

}  // namespace adit::pack
