#pragma once

#include <string>

#include "cli/options.hpp"

namespace adit::cli {

/// The text of `adit COMMAND --help`; null: of `adit --help`.
[[gnu::cold]] std::string help_about(const CommandRow* command);

/// The line after an error that names the right help.
[[gnu::cold]] std::string see_help(const CommandRow* command);

}  // namespace adit::cli
