#pragma once

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit run`: the present run.
Outcome present_run(const Options& options, bool colour);

/// `adit runs`: the kept runs; one of them, its report, or its deletion.
Outcome runs(const Options& options, const Console& console);

}  // namespace adit::cli
