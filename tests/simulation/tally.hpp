#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/run.hpp"

namespace adit::simulation {

/// What came of many runs. Of plain numbers, to be handed from one process to another.
struct Tally {
  std::uint64_t runs = 0, events = 0, faults = 0, failed = 0;
  double hours = 0;  // simulated
  double cpu = 0;    // seconds

  void add(const Outcome& outcome);
  void add(const Tally& other);
  std::string sentence(std::uint64_t first_seed) const;
};

}  // namespace adit::simulation
