#pragma once

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit spare`.
Outcome spare(const Options& options, const Console& console);

}  // namespace adit::cli
