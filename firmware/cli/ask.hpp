#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit status` and `adit reports`: asks the running Adit and shows its answer.
Outcome status(const Options& options, bool colour);
Outcome reports(const Options& options, bool colour);

}  // namespace adit::cli
