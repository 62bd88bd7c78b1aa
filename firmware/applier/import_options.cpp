#include "applier/import.hpp"

namespace adit::applier {

command_line::Program import_command_line_of(ImportOptions& options) {
  return {
      .name = "adit-import",
      .usage = "",
      .about =
          "Takes the settings, the network's numbers and the tokens that somebody put on Adit's boot "
          "partition, all of them or, where anything is wrong, nothing; taken.txt beside them says what "
          "became of each. Runs before aditd.",
      .rows = {{"--card", "DIR", "where they were put: settings.json, network.json, secrets/*.token",
                &options.card},
               {"--state", "DIR", "aditd's state", &options.state},
               {"--network", "DIR", "adit-network's state", &options.network},
               {"--given", "FILE", "the settings that count until others are saved", &options.given},
               {"--memory", "FILE",
                "where it is there, the state is lost at the next start, and what is taken stays on the card",
                &options.in_memory},
               {"--version", "", "prints the version", &options.version},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Exits 0 also where there was nothing, or what was there is wrong; 1 where what is right could not "
          "be taken (and says why); 2 on a wrong command line.",
  };
}

}  // namespace adit::applier
