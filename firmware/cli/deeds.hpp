#pragma once

#include "cli/options.hpp"
#include "cli/outcome.hpp"
#include "settings/settings.hpp"

namespace adit::cli {

/// `adit reports send`, `withdraw`, `done` and `resubmit`: each report in turn, as far as Adit can be asked.
Outcome judge(const settings::Address& address, const Options& options);

/// `adit run new`
Outcome begin_run(const Options& options);

}  // namespace adit::cli
