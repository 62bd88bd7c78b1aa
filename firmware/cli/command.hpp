#pragma once

#include <span>
#include <string_view>

#include "cli/console.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// The whole of `adit`: `words` are its arguments.
Outcome run(std::span<const std::string_view> words, const Console& console = {});

/// The command of a line that has been read, neither help nor the version.
Outcome run(const Options& options, const Console& console);

}  // namespace adit::cli
