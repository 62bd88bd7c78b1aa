#pragma once

#include <functional>
#include <string>

#include "cli/options.hpp"
#include "cli/outcome.hpp"

namespace adit::cli {

/// `adit update`: how the box's update stands; installs one from a file or from the box's USB stick, and
/// waits for its end; restarts the box. What takes a while is told to `print`.
Outcome update(const Options& options, const std::function<void(const std::string&)>& print);

}  // namespace adit::cli
