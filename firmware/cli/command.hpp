#pragma once

#include <span>
#include <string_view>

#include "cli/console.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// The whole of `adit`: `words` are its arguments.
Outcome run(std::span<const std::string_view> words, const Console& console = {});

}  // namespace adit::cli
