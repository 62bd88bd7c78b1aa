#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit settings`, asked of the running Adit.
Outcome settings(const Options& options, bool colour);

/// `adit course`: lists the courses, or switches to one.
Outcome course(const Options& options, bool colour);

}  // namespace adit::cli
