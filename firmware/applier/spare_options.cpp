#include "applier/spare_options.hpp"

namespace adit::applier {

command_line::Program spare_command_line_of(SpareOptions& options) {
  return {
      .name = "adit-spare",
      .usage = "",
      .about =
          "Write the export for a spare box to the USB stick in the box, and read exports from it, on "
          "aditd's requests. Write which exports are on the stick. End when there are no more requests.",
      .rows = {{"--wanted", "DIR", "directory of aditd's requests", &options.wanted},
               {"--status", "DIR", "directory of the answers", &options.status},
               {"--sticks", "DIR", "directory in which USB sticks are mounted, read-only", &options.sticks},
               {"--block", "DIR", "the kernel's directory of disks", &options.block},
               {"--devices", "DIR", "directory of the disks' devices", &options.devices},
               {"--mount", "CMD", "systemd-mount, to mount sticks", &options.mount},
               {"--version", "", "print the version", &options.version},
               {"--help", "", "print this help", &options.help}},
      .ending = "Exit code: 0 on success; 1 if an error occurred; 2 for a wrong command line.",
  };
}

}  // namespace adit::applier
