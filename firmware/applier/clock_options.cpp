#include "applier/clock_options.hpp"

namespace adit::applier {

command_line::Program clock_command_line_of(ClockOptions& options) {
  return {
      .name = "adit-clock",
      .usage = "",
      .about =
          "Sets the time of day, as aditd asks, and tells who set it last. Has chronyd speak NTP on the "
          "team's "
          "network, where that is asked for. Ends once nothing is asked for.",
      .rows = {{"--wanted", "DIR", "where aditd asks", &options.wanted},
               {"--status", "DIR", "where it is answered", &options.status},
               {"--chip", "DIR", "where the kernel tells of a clock with a battery", &options.chip},
               {"--chip-device", "FILE", "that clock, which is set too", &options.chip_device},
               {"--team", "NAME", "the interface on which NTP is spoken", &options.team},
               {"--systemctl", "CMD", "systemd, which runs chronyd", &options.systemctl},
               {"--version", "", "prints the version", &options.version},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Exits 0 once it is done, 1 where it cannot do its work (and says why), 2 on a wrong command line.",
  };
}

}  // namespace adit::applier
