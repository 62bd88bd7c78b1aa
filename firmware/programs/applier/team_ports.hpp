#pragma once

#include <expected>
#include <string>

#include "applier/options.hpp"

namespace adit::applier {

/// Writes the firewall's rules for the ports that aditd requested, if it has requested any. systemd then
/// loads the file. Error: the file cannot be written, or the request cannot be removed.
std::expected<void, std::string> write_port_rules(const Options& options);

}  // namespace adit::applier
