#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit reports` and its verbs.
Outcome reports(const Options& options, bool colour);

}  // namespace adit::cli
