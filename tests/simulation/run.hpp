#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/history.hpp"
#include "simulation/omissions.hpp"

namespace adit::simulation {

struct Plan {
  std::uint64_t seed = 0;
  Omissions without = {};
  Telling tells = Telling::Nothing;
};

struct Outcome {
  std::uint64_t hash = 0;
  double seconds = 0;  // simulated
  std::uint64_t steps = 0;
  std::size_t faults = 0;
  std::string drawn;                // the faults of the run
  std::vector<std::string> broken;  // violations: "Once: ..."
  Actions actions;
};

Outcome play(const Plan& plan);

}  // namespace adit::simulation
