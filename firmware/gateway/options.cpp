#include "gateway/options.hpp"

namespace adit::gateway {

command_line::Program command_line_of(Options& options) {
  using command_line::Wanted;
  return {
      .name = "aditd",
      .usage = "",
      .about = "Adit's gateway between a robot team and the Command Post.",
      .rows =
          {{"--settings", "FILE",
            "the settings (JSON, version 1) unless others were saved; `adit check FILE` explains what is "
            "wrong with them",
            &options.settings, Wanted::Always},
           {"--secrets", "DIR",
            "may hold scoring.token, mapping.token, team.token and label.code, readable by nobody else",
            &options.secrets, Wanted::Always},
           {"--state", "DIR",
            "where the ledger of reports is kept, and what is set up by the page: settings.json and "
            "secrets/, which count before the other two; made where it is absent",
            &options.state, Wanted::Always},
           {"--network", "DIR", "where adit-network tells how it stands", &options.network},
           {"--watch", "DIR", "where adit-network --watch tells who else uses the box's addresses",
            &options.watch},
           {"--update", "DIR", "where adit-update tells how it stands", &options.update},
           {"--clock", "DIR", "where adit-clock tells how it stands", &options.clock},
           {"--spare", "DIR", "where adit-spare tells how it stands", &options.spare},
           {"--board", "FILE",
            "what the board is, and where its lights and its button are: counts before the settings' "
            "panel; may be absent",
            &options.board},
           {"--panel", "SOCKET",
            "of adit-panel, which holds lights and button; without it aditd holds them itself, and nobody "
            "shows that it hangs",
            &options.panel},
           {"--notices", "DIR",
            "sentences for the operator, a file each, of the programs that start the box and watch it",
            &options.notices},
           {"--version", "", "print the version", &options.version},
           {"--help", "", "print this help", &options.help}},
      .ending =
          "What waits and who is logged in is kept across a restart in $RUNTIME_DIRECTORY, or else in the "
          "state folder.\n"
          "Exits 0 after SIGTERM or SIGINT, 1 where it cannot start (and says why), 2 on a wrong command "
          "line.",
      .empty = command_line::Empty::Taken,
  };
}

}  // namespace adit::gateway
