#pragma once

#include <cstdint>
#include <vector>

#include "icd/map_update.hpp"
#include "lanes/sender.hpp"

namespace adit::lanes {

/// Two clouds of one sender that wait, one right behind the other: of the same fields, byte order and origin.
struct Successive {
  Sender sender;
  std::vector<std::uint64_t> older_updates, newer_updates;  // WaitingMap's, by which they are known again
  icd::MapData older, newer;                                // not compressed
  std::uint32_t point_step = 0;                             // bytes
};

}  // namespace adit::lanes
