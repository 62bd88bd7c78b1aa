#pragma once

#include "cli/ask.hpp"
#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit reports send`, `hold`, `withdraw`, `done` and `resubmit`: each report in turn, as far as Adit can be
/// asked. Before one in doubt is sent, the console is asked, unless the options say that it is meant.
Outcome judge(const Adit& adit, const Options& options, const Console& console);

/// `adit run new`
Outcome begin_run(const Options& options);

/// `adit identify`
Outcome identify(const Options& options);

}  // namespace adit::cli
