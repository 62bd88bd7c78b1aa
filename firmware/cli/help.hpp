#pragma once

#include <string>

#include "cli/commands.hpp"

namespace adit::cli {

/// What `adit --help`, or `adit COMMAND --help`, prints.
[[gnu::cold]] std::string help_about(Command command);

/// The line below an error of a command line: which help to read.
[[gnu::cold]] std::string see_help(Command command);

}  // namespace adit::cli
