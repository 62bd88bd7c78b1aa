#pragma once

#include <functional>
#include <string>

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit test`: begins the Test, or joins one that runs, and gives each step to `print` as it ends.
Outcome test(const Options& options, bool colour, const std::function<void(const std::string&)>& print);

}  // namespace adit::cli
