#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/history.hpp"

namespace adit::simulation {

struct Outcome {
  std::uint64_t hash = 0;
  double seconds = 0;  // simulated
  std::uint64_t steps = 0;
  std::size_t faults = 0;
  std::string drawn;                // which faults exist
  std::vector<std::string> broken;  // "Once: ..."
};

/// Plays the run of that seed. `log`: each event as it comes.
Outcome play(std::uint64_t seed, bool log);

}  // namespace adit::simulation
