#pragma once

#include <vector>

#include "settings/settings.hpp"

namespace adit::settings {

/// What is wrong with the addresses of the box's own interfaces: each alone, and the team's subnet where it
/// overlaps anything of the Command Post's (ICD 3), unless that is allowed on purpose.
std::vector<Error> network_faults(const Settings& settings);

/// The overlaps alone, whether they are allowed or not; "" where there is none.
std::string overlap(const Settings& settings);

}  // namespace adit::settings
