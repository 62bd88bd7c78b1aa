#include "panel/panel_options.hpp"

namespace adit::panel {

command_line::Program panel_command_line_of(PanelOptions& options) {
  return {
      .name = "adit-panel",
      .usage = "",
      .about =
          "Holds the panel's lights and button for aditd, and shows the fault where aditd dies or hangs.",
      .rows = {{"--board", "FILE",
                "what the board is (board.json); where it names a panel, that counts before what aditd says",
                &options.board},
               {"--socket", "SOCKET", "where aditd finds it (aditd --panel); not with a socket of systemd's",
                &options.socket},
               {"--simulated", "FILE",
                "where the lights are shown while no line is named; the button is the FIFO FILE.button",
                &options.simulated},
               {"--version", "", "prints the version", &options.version},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Exits 0 after SIGTERM or SIGINT, with all lights dark, 1 where it cannot start (and says why), "
          "2 on a wrong command line.",
      .empty = command_line::Empty::Taken,
  };
}

}  // namespace adit::panel
