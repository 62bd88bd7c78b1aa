#include "applier/update_options.hpp"

#include "command_line/number.hpp"

namespace adit::applier {

command_line::Program update_command_line_of(UpdateOptions& options) {
  return {
      .name = "adit-update",
      .usage = "[good]",
      .about =
          "Update the box by RAUC, on aditd's requests: check a bundle, install it into the slot that is not "
          "running, and reboot. End when there are no more requests.",
      .rows = {{"good", "",
                "watch a boot instead: mark the slot good once aditd is healthy, or reboot if a slot on "
                "trial does not become healthy",
                &options.good},
               {"--within", "SECONDS", "time that a slot on trial has for this (300)",
                command_line::number<1, 3600>(options.within)},
               {"--wanted", "DIR", "directory of aditd's requests", &options.wanted},
               {"--status", "DIR", "directory of the answers", &options.status},
               {"--state", "DIR", "directory of the last update's outcome", &options.state},
               {"--sticks", "DIR", "directory in which USB sticks are mounted", &options.sticks},
               {"--os-release", "FILE", "file whose VERSION_ID is the running version", &options.os_release},
               {"--hindrance", "FILE", "if this file exists, install no update: it has the reason",
                &options.hindrance},
               {"--rauc", "CMD", "RAUC", &options.rauc},
               {"--systemctl", "CMD", "systemd", &options.systemctl},
               {"--version", "", "print the version", &options.version},
               {"--help", "", "print this help", &options.help}},
      .ending = "Exit code: 0 on success; 1 if an error occurred; 2 for a wrong command line.",
  };
}

}  // namespace adit::applier
