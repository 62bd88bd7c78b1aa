#pragma once

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit ledger`: prints the records of a ledger's files, or begins another ledger.
Outcome ledger(const Options& options, const Console& console);

}  // namespace adit::cli
