#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings/subnet.hpp"

namespace adit::host {

/// All IPv4 addresses of an interface, link-local ones last (the kernel has them first); none where there is
/// no such interface.
std::vector<settings::Subnet> own_addresses(const std::string& interface);

/// The first of them.
std::optional<settings::Subnet> own_address(const std::string& interface);

}  // namespace adit::host
