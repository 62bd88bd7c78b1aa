#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cli/ask.hpp"
#include "cli/options.hpp"

namespace adit::cli {

/// The text of `adit COMMAND --help`; null: of `adit --help`.
[[gnu::cold]] std::string help_about(const CommandRow* command);

/// The line after an error that names the right help.
[[gnu::cold]] std::string see_help(const CommandRow* command);

/// Runs `adit` with the arguments `words`.
Outcome run(std::span<const std::string_view> words, const Console& console = {});

/// Runs the command of a parsed line, except help and version.
Outcome run(const Options& options, const Console& console);

}  // namespace adit::cli
