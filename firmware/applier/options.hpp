#pragma once

#include "command_line/read.hpp"

namespace adit::applier {

/// adit-network's command line. It names the interfaces, so that a request can change only these two.
struct Options {
  std::string wanted = "/var/lib/private/adit";          // directory of aditd's requests
  std::string status = "/run/adit-network";              // directory of the status, readable by all
  std::string told = "/run/adit-network";                // directory in which the watch reads adit-network's
                                                         // status
  std::string state = "/var/lib/adit-network";           // the confirmed numbers
  std::string networkd = "/run/systemd/network";         // networkd's directory in memory
  std::string factory = "/usr/share/adit/network.json";  // the factory addresses
  std::string networkctl = "networkctl";
  std::string team = "team0", command_post = "darpa0";
  bool start = false;  // writes networkd's files before networkd starts, then exits
  bool watch = false;  // only listens for address conflicts
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);

/// An error names the wrong word.
[[gnu::cold]] std::expected<Options, std::string> parse_options(std::span<const char* const> arguments);

}  // namespace adit::applier
