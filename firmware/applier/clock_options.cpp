#include "applier/clock_options.hpp"

namespace adit::applier {

command_line::Program clock_command_line_of(ClockOptions& options) {
  return {
      .name = "adit-clock",
      .usage = "",
      .about =
          "Set the time of day on aditd's requests, and write which source set it last. If requested, run "
          "chronyd for NTP on the team's "
          "network. End when there are no more requests.",
      .rows = {{"--wanted", "DIR", "directory of aditd's requests", &options.wanted},
               {"--status", "DIR", "directory of the answers", &options.status},
               {"--chip", "DIR", "the kernel's directory of a battery-backed clock", &options.chip},
               {"--chip-device", "FILE", "that clock's device, to set it", &options.chip_device},
               {"--team", "NAME", "interface for NTP", &options.team},
               {"--systemctl", "CMD", "systemctl, to start and stop chronyd", &options.systemctl},
               {"--version", "", "print the version", &options.version},
               {"--help", "", "print this help", &options.help}},
      .ending = "Exit code: 0 on success; 1 if an error occurred; 2 for a wrong command line.",
  };
}

}  // namespace adit::applier
