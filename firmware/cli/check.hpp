#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

Outcome check(const Options& options, bool colour);

}  // namespace adit::cli
