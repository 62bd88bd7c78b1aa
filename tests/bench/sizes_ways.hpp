#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::bench {

/// A way to make a map's data small: what it makes of it, in bytes.
struct PackingWay {
  std::string name;
  bool is_slow = false;  // left out of a short run
  bool is_kept = false;  // is given a grid's data as Adit keeps it, and not as it came
  std::function<std::size_t(const icd::MapUpdate&)> pack;
};

/// zlib 6 and 9 are the first two: what the others are set beside.
std::vector<PackingWay> ways_for_grids();
std::vector<PackingWay> ways_for_clouds();

/// As codec keeps a grid until it is sent.
icd::MapUpdate as_kept(icd::MapUpdate grid);

struct Measured {
  std::size_t bytes = 0;
  std::chrono::duration<double, std::milli> cpu{};  // of the thread; the least of some rounds
};
Measured measured(const PackingWay& way, const icd::MapUpdate& map);

}  // namespace adit::bench
