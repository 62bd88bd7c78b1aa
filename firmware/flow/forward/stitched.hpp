#pragma once

#include <cstddef>
#include <optional>

#include "icd/chunked_bytes.hpp"
#include "icd/mapping.hpp"
#include "icd/status.hpp"
#include "pack/pack.hpp"
#include "queues/clouds.hpp"
#include "queues/lattice.hpp"
#include "queues/map_queue.hpp"

namespace adit::forward {

/// A map in its form for the Command Post.
struct PackedMap {
  icd::ChunkedBytes body;           // empty: has_no_valid_point, or the data of a part is damaged
  icd::MapData stitched;            // cells from its parts
  bool has_no_valid_point = false;  // a piece of a cloud; nothing is sent
  queues::Precision precision = queues::Precision::Exact;  // a cloud's rounding
  std::size_t points_size = 0;                             // sent points, unpacked
  std::size_t full_size = 0;                               // the same, packed by Effort::Full or as estimated
  pack::Effort effort = pack::Effort::Full;
  double expected = 0;  // packing seconds (pack::seconds_for)
  /// `ground` with the map drawn over it; nullopt: not wanted, or damaged.
  std::optional<queues::Ground> drawn;
};

struct Packing {
  bool arranges_clouds = true;
  /// Decides the effort for grids and for clouds that are not rounded.
  pack::EffortInput hurry{};
};

/// Rounds a cloud to waiting.precision, or keeps it exact if that is impossible. A map that goes as it is
/// (queues::PackingRule) only loses invalid points. CPU-bound: call on a worker.
PackedMap pack_map(const queues::QueuedMap& waiting, const Packing& packing = {});

/// The map with its cells, stitched from its parts over the ground if necessary, or with the points or
/// rows that are sent next. An error describes the fault in the data.
icd::Checked<icd::MapUpdate> assemble(const queues::QueuedMap& waiting);

}  // namespace adit::forward
