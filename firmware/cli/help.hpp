#pragma once

#include "cli/options.hpp"

namespace adit::cli {

/// What `adit --help`, or `adit COMMAND --help`, prints.
const char* help_about(Command command);

/// One line, for standard error.
extern const char* const kSeeHelp;

}  // namespace adit::cli
