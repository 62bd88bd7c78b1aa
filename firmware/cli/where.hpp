#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "settings/settings.hpp"

namespace adit::cli {

/// "10.0.0.1:8000" or "[fd00::1]:8000"; without a port: port 8000.
std::expected<settings::Address, std::string> parse_address(std::string_view text);
std::string written(const settings::Address& address);

/// Where an Adit with these settings is reached from this machine. Where it listens at every address of
/// team.interface, that is an address of this interface: a socket bound to it does not answer on loopback.
std::expected<settings::Address, std::string> reach(const settings::Team& team);

}  // namespace adit::cli
