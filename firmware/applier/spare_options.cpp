#include "applier/spare_options.hpp"

namespace adit::applier {

command_line::Program spare_command_line_of(SpareOptions& options) {
  return {
      .name = "adit-spare",
      .usage = "",
      .about =
          "Writes the export for a spare box to the USB stick in the box, and reads one from it, as aditd "
          "asks; and tells what is on the stick. Ends once nothing is asked for.",
      .rows = {{"--wanted", "DIR", "where aditd asks", &options.wanted},
               {"--status", "DIR", "where it is answered", &options.status},
               {"--sticks", "DIR", "in whose folders USB sticks are mounted, read-only", &options.sticks},
               {"--block", "DIR", "where the kernel tells of disks", &options.block},
               {"--devices", "DIR", "where disks are", &options.devices},
               {"--mount", "CMD", "systemd-mount, which mounts them", &options.mount},
               {"--version", "", "prints the version", &options.version},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Exits 0 once it is done, 1 where it cannot do its work (and says why), 2 on a wrong command line.",
  };
}

}  // namespace adit::applier
