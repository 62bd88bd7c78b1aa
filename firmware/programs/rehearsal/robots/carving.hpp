#pragma once

#include <vector>

#include "rehearsal/robots/random.hpp"
#include "rehearsal/robots/raster.hpp"

namespace adit::robots {

struct Chamber {
  double x = 0, y = 0, floor = 0, radius = 0;  // metres
};

/// 1 where the mountain is hollow. The first chamber is the entrance.
using Hollow = Raster<std::uint8_t>;

/// The entrance at (0, 0) and chambers spread over the lattice.
std::vector<Chamber> spread_chambers(const Lattice& lattice, Random& random);

/// Carves the chambers and the tunnels that join them all, roughens the walls, and fills whatever cannot be
/// reached from the entrance.
Hollow carve(const Lattice& lattice, const std::vector<Chamber>& chambers, Random& random);

}  // namespace adit::robots
