#pragma once

#include <span>
#include <string_view>

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// Runs `adit` with the arguments `words`.
Outcome run(std::span<const std::string_view> words, const Console& console = {});

/// Runs the command of a parsed line, except help and version.
Outcome run(const Options& options, const Console& console);

}  // namespace adit::cli
