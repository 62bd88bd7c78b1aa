#pragma once

#include <cstdint>
#include <string>

#include "simulation/omissions.hpp"

namespace adit::simulation {

/// A run that breaks the check of that name, made small: whatever it breaks without is left out, first whole
/// actors, then ranges, then single actions. Plays the run anew for each that it tries, `most_plays` times at
/// most.
Omissions shrunk(std::uint64_t seed, const Omissions& from, const std::string& check, int most_plays);

}  // namespace adit::simulation
