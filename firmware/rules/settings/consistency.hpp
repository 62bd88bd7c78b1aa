#pragma once

#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

/// Contradictions between settings that are valid on their own.
std::vector<Error> contradictions(const Settings& settings);

/// The same for the panel alone.
void check_panel(const Panel& panel, std::vector<Error>& errors);

}  // namespace adit::settings
