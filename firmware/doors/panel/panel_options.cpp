#include "panel/panel_options.hpp"

namespace adit::panel {

command_line::Program panel_command_line_of(PanelOptions& options) {
  return {
      .name = "adit-panel",
      .usage = "",
      .about = "Hold the panel's lights and button for aditd. If aditd dies or hangs, show the fault.",
      .rows = {{"--board", "FILE",
                "the board's description (board.json); if it names a panel, that panel is used instead of "
                "aditd's",
                &options.board},
               {"--socket", "SOCKET", "socket for aditd (aditd --panel); not with a socket from systemd",
                &options.socket},
               {"--simulated", "FILE",
                "show the lights in this file while no line is named; the button is the FIFO FILE.button",
                &options.simulated},
               {"--version", "", "print the version", &options.version},
               {"--help", "", "print this help", &options.help}},
      .ending =
          "Exit code: 0 after SIGTERM or SIGINT, with all lights dark; 1 if it cannot start; 2 for a wrong "
          "command line.",
      .empty = command_line::Empty::Taken,
  };
}

}  // namespace adit::panel
