#pragma once

#include "command_line/read.hpp"

namespace adit::applier {

/// adit-network's command line. Interfaces stand here and not in what aditd asks for: it can move these two
/// alone.
struct Options {
  std::string wanted = "/var/lib/private/adit";          // where aditd asks
  std::string status = "/run/adit-network";              // where it is answered, for everybody to read
  std::string told = "/run/adit-network";                // where the watch reads what adit-network tells
  std::string state = "/var/lib/adit-network";           // what was confirmed last
  std::string networkd = "/run/systemd/network";         // networkd's folder that is gone at the next start
  std::string factory = "/usr/share/adit/network.json";  // the addresses that the box comes with
  std::string networkctl = "networkctl";
  std::string team = "team0", command_post = "darpa0";
  bool start = false;  // only writes networkd's files, before networkd is there
  bool watch = false;  // only listens whether another machine uses the box's addresses
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);

/// What is wrong names the word it is about.
[[gnu::cold]] std::expected<Options, std::string> parse_options(std::span<const char* const> arguments);

}  // namespace adit::applier
