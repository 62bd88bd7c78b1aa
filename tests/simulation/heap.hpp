#pragma once

#include <cstddef>

namespace adit::simulation {

/// Bytes allocated with malloc(3) now.
std::size_t heap();
/// The largest single request in bytes since the last call, granted or not.
std::size_t most_wanted();

}  // namespace adit::simulation
