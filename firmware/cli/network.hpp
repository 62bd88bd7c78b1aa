#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit network show`, `confirm` and `revert`.
Outcome network(const Options& options);

}  // namespace adit::cli
