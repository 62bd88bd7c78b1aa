#pragma once

#include <string>

#include "settings/settings.hpp"

namespace adit::gateway {

/// The box's IPv4 address for the team. "": it has none, or it cannot be read, which is logged.
std::string team_address(const settings::Team& team);

}  // namespace adit::gateway
