#pragma once

#include <cstdint>
#include <string>

#include "simulation/omissions.hpp"

namespace adit::simulation {

/// A run in which a check found that, made small: all is left out without which it finds the same, to the
/// word: another sentence of the same check may have another cause. First whole actors, then ranges, then
/// single actions. Plays the run again for each that it tries, `most_plays` times at most.
Omissions shrunk(std::uint64_t seed, const Omissions& from, const std::string& broken, int most_plays);

}  // namespace adit::simulation
