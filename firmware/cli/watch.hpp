#pragma once

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit watch`: until a signal, or q on a terminal, ends it.
Outcome watch(const Options& options, const Console& console);

}  // namespace adit::cli
