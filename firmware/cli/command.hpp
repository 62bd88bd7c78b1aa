#pragma once

#include <span>
#include <string_view>

#include "cli/outcome.hpp"

namespace adit::cli {

/// The whole of `adit`, but for printing: `words` are its arguments.
Outcome run(std::span<const std::string_view> words, bool colour);

}  // namespace adit::cli
