#pragma once

#include <optional>
#include <string>

#include "settings/subnet.hpp"

namespace adit::host {

/// The first IPv4 address of an interface; nothing where it has none, or there is no such interface. By
/// ioctl, as the service may use no netlink.
std::optional<settings::Subnet> own_address(const std::string& interface);

}  // namespace adit::host
