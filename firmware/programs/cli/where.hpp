#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "settings/settings.hpp"

namespace adit::cli {

/// "10.0.0.1:8000" or "[fd00::1]:8000". The default port is 8000.
std::expected<settings::Address, std::string> parse_address(std::string_view text);
std::string written(const settings::Address& address);

/// The address of an Adit with these settings, from this machine. If it listens at all addresses of
/// team.interface, returns one of them, because a socket bound to the interface does not answer on loopback.
std::expected<settings::Address, std::string> reach(const settings::Team& team);

}  // namespace adit::cli
