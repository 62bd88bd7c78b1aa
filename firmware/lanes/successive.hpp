#pragma once

#include <cstdint>
#include <vector>

#include "icd/map_update.hpp"
#include "lanes/sender.hpp"

namespace adit::lanes {

/// Two successive queued clouds of one sender with the same fields, byte order and origin.
struct Successive {
  Sender sender;
  std::vector<std::uint64_t> older_updates, newer_updates;  // WaitingMap::updates, to find them again
  icd::MapData older, newer;                                // not compressed
  std::uint32_t point_step = 0;                             // bytes
};

}  // namespace adit::lanes
