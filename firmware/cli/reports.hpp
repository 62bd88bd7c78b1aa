#pragma once

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit reports` and its verbs.
Outcome reports(const Options& options, const Console& console);

}  // namespace adit::cli
