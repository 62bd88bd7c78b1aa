#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings/subnet.hpp"

namespace adit::host {

/// The first IPv4 address of an interface; nothing where it has none, or there is no such interface.
std::optional<settings::Subnet> own_address(const std::string& interface);

/// All IPv4 addresses of an interface, by netlink (getifaddrs(3)).
std::vector<settings::Subnet> own_addresses(const std::string& interface);

}  // namespace adit::host
