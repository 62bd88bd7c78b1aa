#pragma once

#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

/// What is wrong between settings that are each right.
std::vector<Error> contradictions(const Settings& settings);

}  // namespace adit::settings
