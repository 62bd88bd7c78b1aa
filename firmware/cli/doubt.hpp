#pragma once

#include <optional>

#include "cli/ask.hpp"
#include "cli/console.hpp"

namespace adit::cli {

/// Why report `number` is not to be sent: it is in doubt, and whoever is at the console does not want it, or
/// nobody is there; or it cannot be looked at. Nothing: it may be sent.
std::optional<Failure> doubt(const Adit& adit, std::int64_t number, const Console& console);

/// Why it is not done; nothing if the operator confirms.
std::optional<Failure> doubt(const Options& options, const Console& console, const std::string& why,
                             const std::string& question);

}  // namespace adit::cli
