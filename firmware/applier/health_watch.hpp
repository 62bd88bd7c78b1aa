#pragma once

#include <expected>
#include <string>

#include "applier/options.hpp"

namespace adit::applier {

/// `adit-update good`: waits until the running slot is good and marks it so, or restarts the machine.
std::expected<void, std::string> watch_health(const UpdateOptions& options);

}  // namespace adit::applier
