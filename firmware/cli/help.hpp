#pragma once

#include <string>

#include "cli/options.hpp"

namespace adit::cli {

/// What `adit COMMAND --help` prints; null: `adit --help`.
[[gnu::cold]] std::string help_about(const CommandRow* command);

/// The line below an error of a command line: which help to read.
[[gnu::cold]] std::string see_help(const CommandRow* command);

}  // namespace adit::cli
