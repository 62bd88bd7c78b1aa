#pragma once

#include <cstddef>
#include <optional>

#include "forward/taken_points.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"
#include "lanes/ground.hpp"
#include "lanes/map_lane.hpp"
#include "lanes/precision.hpp"
#include "pack/effort.hpp"

namespace adit::forward {

/// A map in the form that goes upstream.
struct Packed {
  icd::ChunkedBytes body;  // empty: all of it is left out, or its data or that of a part is damaged
  icd::MapData stitched;   // its cells, where they were in its parts alone
  LeftOut left_out;
  lanes::Precision precision = lanes::Precision::Exact;  // of a cloud: what it was rounded to
  std::size_t points_size = 0;  // of a cloud: bytes of the points that are sent, before they were packed
  pack::Effort effort = pack::Effort::Full;
  double expected = 0;  // seconds for packing it (pack::seconds_for)
  /// What it was packed over, with it; absent where that is not wanted, or its cells are damaged.
  std::optional<lanes::Ground> drawn;
};

/// What is done to a map on its way to that form.
struct Packing {
  bool arranges_clouds = true;
  /// Decides the effort for a grid, and for a cloud that is not rounded.
  pack::Hurry hurry{};
};

/// A cloud goes by waiting.precision, or exact where that cannot be held. CPU-bound in the size of the map:
/// meant for a worker.
Packed packed(const lanes::WaitingMap& waiting, LeavingOut leaving_out = {}, const Packing& packing = {});

/// The map with its cells, which are put together of its parts where they are there alone, over what lies
/// under them where they leave gaps. The error says what is wrong with the data of one.
icd::Checked<icd::MapUpdate> whole_of(const lanes::WaitingMap& waiting);

}  // namespace adit::forward
