#pragma once

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit runs`: the runs that are kept, one of them, its report to print, and its end.
Outcome runs(const Options& options, const Console& console);

}  // namespace adit::cli
