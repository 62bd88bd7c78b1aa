#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit rejected`: the messages that the Command Post would not take, and the operator's word on them.
Outcome rejected(const Options& options, bool colour);

}  // namespace adit::cli
