#pragma once

#include <cstddef>

namespace adit::simulation {

/// What the program has of malloc(3)'s memory, in bytes.
std::size_t heap();
/// The most that it has asked for at once since this was called last, whether or not there was so much.
std::size_t most_wanted();

}  // namespace adit::simulation
