#include "applier/update_options.hpp"

#include "command_line/number.hpp"

namespace adit::applier {

command_line::Program update_command_line_of(UpdateOptions& options) {
  return {
      .name = "adit-update",
      .usage = "[good]",
      .about =
          "Updates the box, by RAUC, as aditd asks: checks a bundle, installs it into the slot that does not "
          "run, and restarts the machine. Ends once nothing is asked for.",
      .rows = {{"good", "",
                "watches a start of the machine instead: marks the slot good once aditd is healthy, or "
                "restarts the machine where a slot on trial does not become so",
                &options.good},
               {"--within", "SECONDS", "how long a slot on trial may take for that (300)",
                command_line::number<1, 3600>(options.within)},
               {"--wanted", "DIR", "where aditd asks", &options.wanted},
               {"--status", "DIR", "where it is answered", &options.status},
               {"--state", "DIR", "where what became of the last update is kept", &options.state},
               {"--sticks", "DIR", "in whose folders USB sticks are mounted", &options.sticks},
               {"--os-release", "FILE", "says by VERSION_ID which version runs", &options.os_release},
               {"--hindrance", "FILE", "says, where it is there, why none may be installed",
                &options.hindrance},
               {"--rauc", "CMD", "RAUC", &options.rauc},
               {"--systemctl", "CMD", "systemd", &options.systemctl},
               {"--version", "", "prints the version", &options.version},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Exits 0 once it is done, 1 where it cannot do its work (and says why), 2 on a wrong command line.",
  };
}

}  // namespace adit::applier
