#pragma once

#include <vector>

#include "queues/marker_queue.hpp"

namespace adit::queues {

/// The changes to send for `older` followed by `newer`.
inline std::vector<icd::Marker> merged(const std::vector<icd::Marker>& older,
                                       const std::vector<icd::Marker>& newer) {
  MarkerChanges changes;
  for (const icd::Marker& marker : older) changes.apply(marker);
  for (const icd::Marker& marker : newer) changes.apply(marker);
  return changes.pop(changes.size());
}

}  // namespace adit::queues
