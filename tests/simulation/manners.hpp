#pragma once

#include <string>

#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

/// An address of the team's network.
inline std::string address(int number) {
  return std::string("10.0.0.").append(std::to_string(20 + number));
}

/// Draws the manners of a client.
inline Manners manners(Random random) {
  return {.keeps_alive = random.chance(0.6),
          .patience = random.chance(0.5) ? random.uniform(0.3, 3) : random.uniform(3, 30),
          .hangs_up = random.chance(0.3) ? random.uniform(0.02, 0.3) : 0,
          .dribbles = random.chance(0.3) ? 0.5 : 0.05,
          .half_closes = random.chance(0.1) ? 0.3 : 0};
}

}  // namespace adit::simulation
