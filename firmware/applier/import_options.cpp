#include "applier/import.hpp"

namespace adit::applier {

command_line::Program import_command_line_of(ImportOptions& options) {
  return {
      .name = "adit-import",
      .usage = "",
      .about =
          "Accept settings, addresses and tokens from Adit's boot partition: all of them, or none if any is "
          "wrong. Write the outcome to taken.txt beside them. To be run before aditd.",
      .rows =
          {{"--card", "DIR", "directory with settings.json, network.json and secrets/*.token", &options.card},
           {"--state", "DIR", "state directory of aditd", &options.state},
           {"--network", "DIR", "state directory of adit-network", &options.network},
           {"--given", "FILE", "settings in use until others are saved", &options.given},
           {"--memory", "FILE",
            "if this file exists, the state is lost at the next boot, and accepted files stay on the card",
            &options.in_memory},
           {"--version", "", "print the version", &options.version},
           {"--help", "", "print this help", &options.help}},
      .ending =
          "Exit code: 0 if there are no files, or if they are wrong or accepted; 1 if correct files could "
          "not be stored; 2 for a wrong command line.",
  };
}

}  // namespace adit::applier
