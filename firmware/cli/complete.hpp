#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit complete`: a line for each word that may stand somewhere, with a tab and what it is.
Outcome complete(const Options& options);

}  // namespace adit::cli
