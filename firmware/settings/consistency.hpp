#pragma once

#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

/// What is wrong between settings that are each right.
std::vector<Error> contradictions(const Settings& settings);

/// The same of the panel alone.
void check_panel(const Panel& panel, std::vector<Error>& errors);

}  // namespace adit::settings
