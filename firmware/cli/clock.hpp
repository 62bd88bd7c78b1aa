#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit clock`: the box's time of day, and who set it; or sets it by this computer's.
Outcome clock(const Options& options);

}  // namespace adit::cli
