#pragma once

#include <string>

#include "cli/commands.hpp"

namespace adit::cli {

/// What `adit --help`, or `adit COMMAND --help`, prints.
[[gnu::cold]] std::string help_about(Command command);

/// One line, for standard error.
extern const char* const kSeeHelp;

}  // namespace adit::cli
